// The solver on recorded problems: cold, warm from the solution of the problem recorded three steps earlier, and
// without any row, where one Riccati sweep is all.
#include <benchmark/benchmark.h>
#include <string>

#include "config/qp_file.hpp"
#include "control/qp/solver.hpp"

namespace control {
namespace {

OcpQp<8, 2> Read(const std::string& name) {
  return config::QpFile(LPVMPC_TEST_DATA "/qp/" + name + ".qp").Build();
}

void Solve(benchmark::State& state, const OcpQp<8, 2>& qp, const OcpQpPoint<8, 2>* warm_start) {
  OcpQpSolver<8, 2> solver(qp.horizon());
  QpResult result;
  for (auto _ : state) {
    result = solver.Solve(qp, warm_start);
    benchmark::DoNotOptimize(result);
  }
  if (result.status != SolverStatus::kSolved) state.SkipWithError("not solved");
  state.counters["iterations"] = result.iterations;
}

void SolveBase(benchmark::State& state, const std::string& name) {
  OcpQp<8, 2> qp = Read(name);
  for (auto& stage : qp.stages) stage.ClearRows();
  Solve(state, qp, nullptr);
}

void SolveCold(benchmark::State& state, const std::string& name) {
  Solve(state, Read(name), nullptr);
}

void SolveWarm(benchmark::State& state, const std::string& name, const std::string& other_name) {
  const OcpQp<8, 2> qp = Read(name);
  OcpQpSolver<8, 2> before(qp.horizon());
  (void)before.Solve(Read(other_name));
  Solve(state, qp, &before.solution());
}

BENCHMARK_CAPTURE(SolveBase, N8, "s0trN8_0044");
BENCHMARK_CAPTURE(SolveBase, N15, "s7trN15_0044");
BENCHMARK_CAPTURE(SolveCold, N8_0005, "s0trN8_0005");
BENCHMARK_CAPTURE(SolveCold, N8_0041, "s0trN8_0041");
BENCHMARK_CAPTURE(SolveCold, N8_0044, "s0trN8_0044");
BENCHMARK_CAPTURE(SolveCold, N15_0041, "s7trN15_0041");
BENCHMARK_CAPTURE(SolveCold, N15_0044, "s7trN15_0044");
BENCHMARK_CAPTURE(SolveCold, N15_0047, "s7trN15_0047");
BENCHMARK_CAPTURE(SolveWarm, N8_0044, "s0trN8_0044", "s0trN8_0041");
BENCHMARK_CAPTURE(SolveWarm, N15_0044, "s7trN15_0044", "s7trN15_0041");
BENCHMARK_CAPTURE(SolveWarm, N15_0047, "s7trN15_0047", "s7trN15_0044");

}  // namespace
}  // namespace control
