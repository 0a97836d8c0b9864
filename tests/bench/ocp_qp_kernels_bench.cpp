// The kernels of the QP solver: Riccati recursion and sweeps, the rows, the interior point's step length, and a change of
// the dual active set.
#include <Eigen/Core>
#include <array>
#include <benchmark/benchmark.h>
#include <string>

#include "control/qp/dual_active_set.hpp"
#include "control/qp/ocp_qp_solver_impl.hpp"
#include "tests/control/random.hpp"
#include "tools/bench/qp_instance.hpp"

namespace control {

// Names the solver's parts for the benchmarks.
struct OcpQpKernels {
  using Solver = OcpQpSolver<8, 2>;

  explicit OcpQpKernels(const std::string& name)
      : qp(tools::QpInstance(LPVMPC_TEST_DATA "/qp/" + name + ".qp").Build()), solver(qp.horizon()) {
    (void)solver.Solve(qp);
    solver.StartRows(qp);
    solver.StartCold(qp);
    (void)solver.Residuals(qp);
    (void)solver.Factorise(qp, true);
    solver.Step(qp, 0.1, false);
  }
  void DataCheck() { benchmark::DoNotOptimize(detail::HasFiniteData(qp)); }
  void BaseRecursion() { benchmark::DoNotOptimize(solver.FactoriseBase(qp)); }
  void RecursionWithRows() { benchmark::DoNotOptimize(solver.Factorise(qp, true)); }
  void Sweep() { SweepFromLastStage(solver.sweep_); }
  void FourSweeps() { SweepFromLastStage(solver.responses_); }
  void RowAssembly() { benchmark::DoNotOptimize(solver.ShiftRows(qp)); }
  void RowScan() { benchmark::DoNotOptimize(solver.FindViolated(qp, nullptr)); }
  void NewtonStepWithItsLength() { solver.Step(qp, 0.1, false); }
  void Residuals() { benchmark::DoNotOptimize(solver.Residuals(qp)); }
  void KktCheck() { benchmark::DoNotOptimize(EvaluateKkt(qp, solver.solution()).Max()); }

  // Of a gradient of ones in the last state alone.
  template <typename SweepStages>
  void SweepFromLastStage(SweepStages& stages) {
    detail::ClearGradients(stages.size() - 1, stages);
    stages.back().p.setOnes();
    detail::SweepRiccati(qp, solver.riccati_, stages.size() - 1, stages);
  }

  OcpQp<8, 2> qp;
  Solver solver;
};

namespace {

void Kernel(benchmark::State& state, const std::string& name, void (OcpQpKernels::*kernel)()) {
  OcpQpKernels kernels(name);
  for (auto _ : state) (kernels.*kernel)();
}

#define LPVMPC_KERNEL(kernel)                                                   \
  BENCHMARK_CAPTURE(Kernel, N8_##kernel, "s0trN8_0044", &OcpQpKernels::kernel); \
  BENCHMARK_CAPTURE(Kernel, N15_##kernel, "s7trN15_0044", &OcpQpKernels::kernel)

LPVMPC_KERNEL(DataCheck);
LPVMPC_KERNEL(BaseRecursion);
LPVMPC_KERNEL(RecursionWithRows);
LPVMPC_KERNEL(Sweep);
LPVMPC_KERNEL(FourSweeps);
LPVMPC_KERNEL(RowAssembly);
LPVMPC_KERNEL(RowScan);
LPVMPC_KERNEL(NewtonStepWithItsLength);
LPVMPC_KERNEL(Residuals);
LPVMPC_KERNEL(KktCheck);

// Argument: rows, all of which press in the end. The time is that of all changes.
void DualSolve(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0));
  testing::Random random(1);
  Eigen::MatrixXd G(size, size);
  for (double& entry : G.reshaped()) entry = random.Uniform(-1.0, 1.0);
  const Eigen::MatrixXd M = G * G.transpose();
  const Eigen::VectorXd value = M * Eigen::VectorXd::Ones(size);
  DualActiveSet dual(size);
  for (auto _ : state) {
    dual.Clear();
    for (int j = 0; j < size; ++j) {
      (void)dual.Add(-kNoBound, 0.0, -1.0, 0.0, value[j]);
      for (int i = 0; i <= j; ++i) dual.SetM(i, j, M(i, j));
    }
    benchmark::DoNotOptimize(dual.Solve(1e-9));
  }
  state.counters["changes"] = dual.changes();
}
BENCHMARK(DualSolve)->Arg(4)->Arg(16)->Arg(48);

}  // namespace
}  // namespace control
