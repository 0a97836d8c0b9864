// The matrices A(p), B(p) of one stage.
#include <benchmark/benchmark.h>

#include "control/vehicle/lpv_model.hpp"

namespace control {
namespace {

void Discretise(benchmark::State& state, Discretisation method) {
  const LpvModel model(VehicleParameters{});
  Scheduling p{.upsilon = static_cast<double>(state.range(0)), .nu = 0.2, .delta = 0.05, .psi = 0.3};
  for (auto _ : state) {
    benchmark::DoNotOptimize(p);
    benchmark::DoNotOptimize(model.Discrete(p, 0.05, method));
  }
}

// Argument: υ [m/s], which decides how often zero-order hold doubles its step.
BENCHMARK_CAPTURE(Discretise, Euler, Discretisation::kEuler)->Arg(12);
BENCHMARK_CAPTURE(Discretise, ZeroOrderHold, Discretisation::kZeroOrderHold)->Arg(1)->Arg(12)->Arg(40);

}  // namespace
}  // namespace control
