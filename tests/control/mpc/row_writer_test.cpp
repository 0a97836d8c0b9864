#include "control/mpc/row_writer.hpp"

#include "gtest/gtest.h"
#include "tests/control/random.hpp"

namespace control {
namespace {

class RowWriterTest : public ::testing::Test {
 protected:
  static constexpr int kHorizon = 3;
  using Row = OcpQpRow<kStates + kInputs, kInputs>;

  [[nodiscard]] const Row& RowAt(std::size_t stage, std::size_t row) const {
    return qp_.stages[stage].rows[row];
  }
  [[nodiscard]] int RowCount(std::size_t stage) const { return qp_.stages[stage].row_count; }
  // What the row bounds.
  static double Value(const Row& row, const QpState& x, const Input& u) {
    return row.C.dot(x) + row.D.dot(u);
  }
  void Fill(int stage) {
    for (int k = 0; k < kMaxRows; ++k) {
      writer_.AddStateBound({.kind = ConstraintKind::kState, .index = k, .step = stage}, kUpsilon, 0.0, 1.0);
    }
  }

  VehicleQp qp_{kHorizon};
  RowWriter writer_{qp_};
  testing::Random random_{21};
};

TEST_F(RowWriterTest, BoundsHoldOneVariableOfTheirStepAlone) {
  for (int index = 0; index < kStates + kInputs; ++index) {
    writer_.Clear();
    writer_.AddStateBound({.step = 2}, index, -1.5, 2.5);
    ASSERT_EQ(RowCount(2), 1);
    const auto x = random_.Filled<QpState>(3.0);
    EXPECT_EQ(Value(RowAt(2, 0), x, random_.Filled<Input>(3.0)), x[index]);
    EXPECT_EQ(RowAt(2, 0).lo, -1.5);
    EXPECT_EQ(RowAt(2, 0).hi, 2.5);
  }
  for (const int index : {kDelta, kAcceleration}) {
    writer_.Clear();
    writer_.AddInputBound({.step = 2}, index, -0.5, kNoBound);
    ASSERT_EQ(RowCount(2), 1);
    const auto u = random_.Filled<Input>(3.0);
    EXPECT_EQ(Value(RowAt(2, 0), random_.Filled<QpState>(3.0), u), u[index]);
    EXPECT_EQ(RowAt(2, 0).lo, -0.5);
    EXPECT_FALSE(RowAt(2, 0).has_hi());
  }
  for (const std::size_t other : {0U, 1U, 3U}) EXPECT_EQ(RowCount(other), 0) << other;
}

TEST_F(RowWriterTest, GeneralRowHoldsTheCombinationGiven) {
  const auto C = random_.Filled<QpState>(1.0);
  const auto D = random_.Filled<Input>(1.0);
  writer_.AddRow({.step = 1}, C, D, -2.0, 3.0);
  ASSERT_EQ(RowCount(1), 1);
  for (int k = 0; k < 5; ++k) {
    const auto x = random_.Filled<QpState>(3.0);
    const auto u = random_.Filled<Input>(3.0);
    EXPECT_NEAR(Value(RowAt(1, 0), x, u), (C.transpose() * x + D.transpose() * u).value(), 1e-12);
  }
  EXPECT_EQ(RowAt(1, 0).lo, -2.0);
  EXPECT_EQ(RowAt(1, 0).hi, 3.0);
}

TEST_F(RowWriterTest, RowsAreHardUnlessSoftnessIsGiven) {
  const QpState C = QpState::Ones();
  const Softness soft{.rho = 4.0, .sigma = 7.0};
  writer_.AddStateBound({.step = 0}, kNu, 0.0, 1.0);
  writer_.AddInputBound({.step = 0}, kDelta, 0.0, 1.0);
  writer_.AddRow({.step = 0}, C, Input::Zero(), 0.0, 1.0);
  writer_.AddStateBound({.step = 0}, kNu, 0.0, 1.0, soft);
  writer_.AddInputBound({.step = 0}, kDelta, 0.0, 1.0, soft);
  writer_.AddRow({.step = 0}, C, Input::Zero(), 0.0, 1.0, soft);
  ASSERT_EQ(RowCount(0), 6);
  for (const std::size_t row : {0U, 1U, 2U}) EXPECT_FALSE(RowAt(0, row).soft()) << row;
  for (const std::size_t row : {3U, 4U, 5U}) {
    EXPECT_EQ(RowAt(0, row).rho, 4.0) << row;
    EXPECT_EQ(RowAt(0, row).sigma, 7.0) << row;
  }
}

TEST_F(RowWriterTest, EachRowBearsTheNameOfItsConstraint) {
  const auto expect_name = [this](std::size_t stage, std::size_t row, ConstraintKind kind, int index) {
    const Constraint& name = writer_.constraint(stage, row);
    EXPECT_EQ(name.kind, kind) << "row " << row << " of stage " << stage;
    EXPECT_EQ(name.index, index) << "row " << row << " of stage " << stage;
    EXPECT_EQ(name.step, static_cast<int>(stage)) << "row " << row;
  };
  writer_.AddStateBound({.kind = ConstraintKind::kState, .index = kUpsilon, .step = 3}, kUpsilon, 0.0, 1.0);
  writer_.AddInputBound({.kind = ConstraintKind::kInput, .index = kAcceleration, .step = 1}, 1, 0.0, 1.0);
  writer_.AddRow({.kind = ConstraintKind::kObstacle, .index = 42, .step = 3}, QpState::Ones(), Input::Zero(),
                 0.0, 1.0);
  writer_.AddRow({.kind = ConstraintKind::kRate, .index = kDelta, .step = 1}, QpState::Ones(), Input::Ones(),
                 0.0, 1.0);
  expect_name(3, 0, ConstraintKind::kState, kUpsilon);
  expect_name(3, 1, ConstraintKind::kObstacle, 42);
  expect_name(1, 0, ConstraintKind::kInput, kAcceleration);
  expect_name(1, 1, ConstraintKind::kRate, kDelta);
}

TEST_F(RowWriterTest, RowWithoutRoomIsReportedAndChangesNothing) {
  Fill(kHorizon);
  EXPECT_TRUE(writer_.fits());
  const Constraint more{.kind = ConstraintKind::kRoad, .index = 99, .step = kHorizon};
  writer_.AddRow(more, QpState::Ones(), Input::Ones(), 0.0, 1.0);
  EXPECT_FALSE(writer_.fits());
  ASSERT_EQ(RowCount(kHorizon), kMaxRows);
  for (std::size_t row = 0; row < kMaxRows; ++row) {
    EXPECT_EQ(writer_.constraint(kHorizon, row).index, static_cast<int>(row));
  }
  writer_.AddInputBound({.step = 1}, kDelta, 0.0, 1.0);
  EXPECT_EQ(RowCount(1), 1);
  EXPECT_FALSE(writer_.fits()) << "a later row that has room does not complete the problem";
}

TEST_F(RowWriterTest, ClearMakesRoomAndLeavesTheRestOfTheProblem) {
  const auto A = random_.Filled<Eigen::Matrix<double, kStates + kInputs, kStates + kInputs>>(1.0);
  qp_.stages[0].A = A;
  for (int stage = 0; stage <= kHorizon; ++stage) Fill(stage);
  writer_.AddStateBound({.step = 0}, kNu, 0.0, 1.0);
  ASSERT_FALSE(writer_.fits());
  writer_.Clear();
  EXPECT_TRUE(writer_.fits());
  for (std::size_t stage = 0; stage <= kHorizon; ++stage) EXPECT_EQ(RowCount(stage), 0) << stage;
  EXPECT_EQ(qp_.stages[0].A, A);
  writer_.AddInputBound({.kind = ConstraintKind::kInput, .index = kDelta, .step = 0}, kDelta, 0.0, 1.0);
  EXPECT_EQ(writer_.constraint(0, 0).kind, ConstraintKind::kInput);
}

}  // namespace
}  // namespace control
