// The control step takes no memory from the heap: neither by operator new (tests/support/allocations.hpp) nor by malloc
// and its kin, which Eigen calls for a matrix of dynamic size and which the linker's --wrap redirects to this file.
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

#include "config/qp_file.hpp"
#include "control/mpc/lpv_affine_mpc.hpp"
#include "control/mpc/lpv_mpc.hpp"
#include "control/traffic/traffic_planner.hpp"
#include "gtest/gtest.h"
#include "tests/control/mpc/closed_loop.hpp"
#include "tests/control/mpc/road_loop.hpp"
#include "tests/support/allocations.hpp"

static std::size_t c_allocations = 0;

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* memory, std::size_t size);

void* __wrap_malloc(std::size_t size) {
  ++c_allocations;
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  ++c_allocations;
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* memory, std::size_t size) {
  ++c_allocations;
  return __real_realloc(memory, size);
}
}

namespace control {
namespace {

using testing::ClosedLoop;

std::size_t Taken() {
  return test_support::Allocations() + c_allocations;
}

TEST(Allocations, AreCounted) {
  std::size_t before = Taken();
  const auto number = std::make_unique<int>(7);
  EXPECT_EQ(Taken() - before, 1u);
  before = Taken();
  volatile Eigen::Index size = 50;
  const Eigen::VectorXd vector = Eigen::VectorXd::Constant(size, *number);
  EXPECT_EQ(Taken() - before, 1u);
  EXPECT_EQ(vector.size(), 50);
}

TEST(Allocations, SolverTakesNone) {
  const OcpQp<8, 2> qp = config::QpFile(LPVMPC_TEST_DATA "/qp/s7trN15_0044.qp").Build();
  OcpQp<8, 2> infeasible = qp, exact = qp, broken = qp;
  ASSERT_TRUE(infeasible.stages[4].AddStateBound(2, 90.0, kNoBound));
  ASSERT_TRUE(exact.stages[4].AddStateBound(2, 90.0, kNoBound, 1.0, 10.0));
  broken.stages[2].A(0, 0) = std::numeric_limits<double>::quiet_NaN();
  OcpQpSolver<8, 2> solver(qp.horizon()),
      impatient(qp.horizon(), {.max_iterations = 2, .max_working_set = 0});
  const OcpQpPoint<8, 2> warm_start(qp.horizon());
  const std::size_t before = Taken();
  const SolverStatus cold = solver.Solve(qp).status;
  const SolverStatus warm = solver.Solve(qp, &warm_start).status;
  const SolverStatus penalised = solver.Solve(exact, &warm_start).status;
  const SolverStatus proven = solver.Solve(infeasible).status;
  const SolverStatus failed = solver.Solve(broken).status;
  const SolverStatus stopped = impatient.Solve(qp).status;
  EXPECT_EQ(Taken(), before);
  EXPECT_EQ(cold, SolverStatus::kSolved);
  EXPECT_EQ(warm, SolverStatus::kSolved);
  EXPECT_EQ(penalised, SolverStatus::kSolved);
  EXPECT_EQ(proven, SolverStatus::kInfeasible);
  EXPECT_EQ(failed, SolverStatus::kNumericalFailure);
  EXPECT_EQ(stopped, SolverStatus::kIterationLimit);
}

TEST(Allocations, ControlStepTakesNone) {
  for (const auto method : {Discretisation::kEuler, Discretisation::kZeroOrderHold}) {
    LpvMpcSettings settings;
    settings.discretisation = method;
    LpvMpc mpc(VehicleParameters{}, settings);
    ClosedLoop loop(mpc, testing::StraightPath(200, 12.0));
    loop.z()[kY] = 0.4;
    loop.obstacles().reserve(100);
    loop.obstacles().push_back({.X = 20.0, .Y = -0.5, .side = PassingSide::kLeft});
    const auto step = [&](SolverStatus expected) {
      const std::size_t before = Taken();
      const Plan& plan = loop.Ask();
      if (plan.status != SolverStatus::kSolved) static_cast<void>(mpc.DiagnoseInfeasibility());
      const std::size_t taken = Taken() - before;
      EXPECT_EQ(taken, 0u);
      EXPECT_EQ(plan.status, expected);
      if (plan.status == SolverStatus::kSolved) loop.Drive(plan);
    };
    while (loop.k() < 60) step(SolverStatus::kSolved);
    loop.obstacles().assign(100, {.X = loop.z()[kX] + 2.0, .side = PassingSide::kLeft});
    step(SolverStatus::kInfeasible);
    loop.obstacles().clear();
    const double Y = loop.z()[kY];
    loop.z()[kY] = std::numeric_limits<double>::quiet_NaN();
    step(SolverStatus::kNumericalFailure);
    loop.z()[kY] = Y;
    mpc.Reset();
    step(SolverStatus::kSolved);
  }
}

// Covers a drive among obstacles, a blocked road, hold, and a step in which nothing is solved.
TEST(Allocations, StepWithTheAffineModelTakesNone) {
  LpvAffineSettings settings;
  settings.iterations = 3;
  settings.converged = 0.0;
  testing::RoadLoop loop(testing::WindingRoad(30.0, 12.0), settings);
  loop.obstacles().reserve(100);
  const auto step = [&](SolverStatus expected) {
    const auto input = loop.Asked();
    const std::size_t before = Taken();
    const Plan& plan = loop.mpc().Step(input);
    const std::size_t taken = Taken() - before;
    EXPECT_EQ(taken, 0u);
    ASSERT_EQ(plan.status, expected);
    if (plan.status == SolverStatus::kSolved) loop.Drive(plan);
  };
  loop.obstacles() = {loop.ObstacleAt(30.0, 0.6, 0.6), loop.ObstacleAt(31.0, -2.5, 0.6)};
  while (loop.s() < 50.0) step(SolverStatus::kSolved);
  loop.obstacles()[0] = loop.ObstacleAt(85.0, 0.0, 3.0);
  for (int k = 0; k < 200; ++k) step(SolverStatus::kSolved);
  EXPECT_LT(loop.z()[kUpsilon], 0.01) << "it holds";
  loop.obstacles().assign(100, loop.ObstacleAt(85.0, 0.0, 0.5));
  step(SolverStatus::kSolved);
  loop.obstacles()[0].X = std::numeric_limits<double>::quiet_NaN();
  step(SolverStatus::kNumericalFailure);
  loop.obstacles().clear();
  loop.mpc().Reset();
  step(SolverStatus::kSolved);
}

// Covers every decision, and more objects than can be considered.
TEST(Allocations, TrafficPlannerTakesNone) {
  const RoadProfile profile(testing::StraightRoad(500.0, 12.0), RoadBounds{.left = 4.0, .right = -4.0}, {});
  TrafficPlanner planner({.footprint = {.front = 2.0, .rear = 2.3, .half_width = 0.9}, .path = {}}, profile);
  const auto plan = [&](const std::vector<Obstacle>& obstacles, Decision expected) {
    planner.Reset();
    const std::size_t before = Taken();
    const Decision decision = planner.Plan(obstacles, {.s = 50.0, .speed = 12.0}).decision;
    EXPECT_EQ(Taken() - before, 0u);
    EXPECT_EQ(decision, expected);
  };
  plan({}, Decision::kDrive);
  plan({{.X = 90.0, .Y = -0.5}}, Decision::kPass);
  plan({{.X = 75.0, .r_y = 3.0, .velocity_X = 5.0}}, Decision::kFollow);
  plan({{.X = 90.0, .Y = -7.0, .r_y = 3.0, .velocity_Y = 2.0}}, Decision::kYield);
  plan({{.X = 90.0, .r_y = 3.0}}, Decision::kWait);
  plan({{.X = 60.0, .r_y = 3.0}}, Decision::kSqueeze);
  plan(std::vector<Obstacle>(100, {.X = 90.0, .r_y = 3.0}), Decision::kWait);
}

}  // namespace
}  // namespace control
