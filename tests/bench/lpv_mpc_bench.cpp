// A whole control step in closed loop on a straight road past an obstacle, averaged over the drive.
#include <benchmark/benchmark.h>

#include "control/mpc/lpv_mpc.hpp"
#include "tests/control/mpc/closed_loop.hpp"

namespace control {
namespace {

// Argument: N.
void ControlStep(benchmark::State& state, Discretisation method) {
  LpvMpcSettings settings;
  settings.discretisation = method;
  settings.horizon = static_cast<int>(state.range(0));
  LpvMpc mpc(VehicleParameters{}, settings);
  const TimeReference reference = testing::StraightPath(200, 12.0);
  const auto start = [&] {
    mpc.Reset();
    testing::ClosedLoop loop(mpc, reference);
    loop.obstacles() = {{.X = 60.0, .Y = -0.5, .side = PassingSide::kLeft}};
    return loop;
  };
  testing::ClosedLoop loop = start();
  double iterations = 0.0;
  for (auto _ : state) {
    const Plan& plan = loop.Ask();
    state.PauseTiming();
    if (plan.status != SolverStatus::kSolved) return state.SkipWithError("not solved");
    iterations += plan.iterations;
    loop.Drive(plan);
    if (loop.k() == 180) loop = start();
    state.ResumeTiming();
  }
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
}

BENCHMARK_CAPTURE(ControlStep, Euler, Discretisation::kEuler)->Arg(8)->Arg(15);
BENCHMARK_CAPTURE(ControlStep, ZeroOrderHold, Discretisation::kZeroOrderHold)->Arg(8)->Arg(15);

}  // namespace
}  // namespace control
