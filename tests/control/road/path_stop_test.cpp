#include "control/road/path_stop.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "control/road/odometer.hpp"
#include "control/vehicle/geometry.hpp"
#include "control/vehicle/single_track.hpp"
#include "tests/control/vehicle/rk4.hpp"

namespace control {
namespace {

constexpr double kTs = 0.05;
constexpr double kRadius = 40.0;
constexpr double kSpeed = 12.0;
constexpr double kSlowest = 2.0;  // least speed for the dynamic model, which needs υ > 0 [m/s]

// A circle to the left about the origin, starting at (R, 0).
std::vector<Eigen::Vector2d> Circle(double metres) {
  std::vector<Eigen::Vector2d> points;
  for (double s = 0.0; s <= metres; s += kSpeed * kTs) {
    points.emplace_back(kRadius * std::cos(s / kRadius), kRadius * std::sin(s / kRadius));
  }
  return points;
}

// A path stop with the odometer that it steers by, and the offset of its path.
class Stopping {
 public:
  explicit Stopping(const TimeReference& reference)
      : reference_(&reference), odometer_({}, kTs, reference), stop_({}, reference) {}

  // Starts at `z`, beside sample k; the path keeps the vehicle's offset from the reference.
  void Start(const State& z, int k) {
    odometer_.Start(z, k);
    const State beside = reference_->At(odometer_.motion().nearest);
    offset_ = LeftOf(beside[kPsi]).dot(Position(z) - Position(beside));
  }
  void Advance(const State* measured, const Input& applied) { odometer_.Advance(measured, applied); }
  void Follow(std::span<const State> plan) { offset_ = stop_.OffsetOf(plan, odometer_.motion()); }
  [[nodiscard]] double Steering(double applied) const {
    return stop_.Steering(odometer_.motion(), offset_, applied);
  }
  [[nodiscard]] double speed() const { return odometer_.motion().speed; }
  [[nodiscard]] double offset() const { return offset_; }

 private:
  const TimeReference* reference_;
  Odometer odometer_;
  PathStop stop_;
  double offset_ = 0.0;
};

// Stops the nonlinear model from a steady turn, `offset_` to the left of the circle, until it is at kSlowest.
class PathStopInACurve : public ::testing::Test {
 protected:
  struct Figures {
    double largest_deviation = 0.0;  // from the circular path [m]
    double largest_step = 0.0;       // of δ from one cycle to the next [rad]
    double smallest_delta = 10.0;
  };

  PathStopInACurve() {
    u_ = {SteadySteering(kRadius - offset_), 0.0};
    z_ << kRadius - offset_, 0.0, kSpeed, 0.0, M_PI / 2.0, kSpeed / (kRadius - offset_);
    for (int i = 0; i < 40; ++i) Advance();  // the sideslip settles
    z_[kX] = kRadius - offset_;
    z_[kY] = 0.0;
    z_[kPsi] = M_PI / 2.0 - std::atan2(z_[kNu], z_[kUpsilon]);
  }

  // Steering angle of the model in a steady turn [rad].
  static double SteadySteering(double radius) {
    const VehicleParameters v;
    const double wheelbase = v.l_f + v.l_r;
    return wheelbase / radius +
           v.m * kSpeed * kSpeed / (2.0 * wheelbase * radius) * (v.l_r / v.C_alpha_f - v.l_f / v.C_alpha_r);
  }
  void Advance() {
    z_ = testing::Rk4(z_, kTs, 50, [this](const State& x) { return model_.Derivative(x, u_); });
  }

  Figures Stop(Stopping& stop, bool measured) {
    Figures figures;
    while (z_[kUpsilon] > kSlowest) {
      const Input u(stop.Steering(u_[kDelta]), -3.0);
      figures.largest_step = std::max(figures.largest_step, std::abs(u[kDelta] - u_[kDelta]));
      figures.smallest_delta = std::min(figures.smallest_delta, u[kDelta]);
      u_ = u;
      Advance();
      stop.Advance(measured ? &z_ : nullptr, u_);
      figures.largest_deviation =
          std::max(figures.largest_deviation, std::abs(z_.head<2>().norm() - (kRadius - offset_)));
    }
    return figures;
  }

  double offset_ = 1.5;
  SingleTrackModel model_{VehicleParameters{}};
  TimeReference reference_{Circle(200.0), kTs};
  State z_;
  Input u_;
};

TEST_F(PathStopInACurve, MeasuredItStaysOnItsPathToTheEnd) {
  Stopping stop(reference_);
  stop.Start(z_, 0);
  EXPECT_NEAR(stop.offset(), offset_, 0.05);
  const Figures figures = Stop(stop, true);
  EXPECT_LT(figures.largest_deviation, 0.25);
  EXPECT_LE(figures.largest_step, 0.5 * kTs + 1e-12);
  EXPECT_GT(figures.smallest_delta, 0.5 * SteadySteering(kRadius));
}

TEST_F(PathStopInACurve, BlindItStaysOnTheRoad) {
  Stopping stop(reference_);
  stop.Start(z_, 0);
  const Figures figures = Stop(stop, false);
  EXPECT_LT(figures.largest_deviation, 1.0);
  EXPECT_GT(figures.smallest_delta, 0.5 * SteadySteering(kRadius));
  EXPECT_NEAR(stop.speed(), z_.segment<2>(kUpsilon).norm(), 0.3);
}

TEST_F(PathStopInACurve, PathEndsWhereTheLastPlanEnds) {
  Stopping stop(reference_);
  stop.Start(z_, 0);
  std::vector<State> plan(9, State::Zero());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const double angle = std::atan2(z_[kY], z_[kX]) + kSpeed * kTs * static_cast<double>(i) / kRadius;
    const double radius = kRadius + 0.2 * static_cast<double>(i);  // to the right
    plan[i][kX] = radius * std::cos(angle);
    plan[i][kY] = radius * std::sin(angle);
  }
  stop.Follow(plan);
  EXPECT_NEAR(stop.offset(), -1.6, 0.05);
}

TEST(PathStop, PastTheEndOfTheReferenceItGoesStraightOn) {
  const TimeReference reference(std::vector<Eigen::Vector2d>{{0.0, 0.0}, {0.5, 0.0}, {1.0, 0.0}}, kTs);
  Stopping stop(reference);
  State z = State::Zero();
  z[kUpsilon] = 10.0;
  stop.Start(z, 0);
  for (int i = 0; i < 20; ++i) {
    z[kX] += 0.5;
    stop.Advance(&z, Input::Zero());
    EXPECT_NEAR(stop.Steering(0.0), 0.0, 1e-12);
  }
}

TEST(PathStop, AssumedSpeedEndsAtStandstillAndTheWheelsAreHeld) {
  const TimeReference reference(Circle(100.0), kTs);
  Stopping stop(reference);
  State z = State::Zero();
  z << kRadius, 0.0, 2.0, 0.0, M_PI / 2.0, 0.0;
  stop.Start(z, 0);
  Input u(0.06, 0.0);
  for (int i = 0; i < 40; ++i) {
    u = {stop.Steering(u[kDelta]), -3.0};
    stop.Advance(nullptr, u);
  }
  EXPECT_EQ(stop.speed(), 0.0);
  EXPECT_EQ(stop.Steering(u[kDelta]), u[kDelta]);
}

}  // namespace
}  // namespace control
