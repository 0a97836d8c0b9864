// The kernels of the QP solver: Riccati recursion and sweeps, the rows, the interior point's step length, and a change of
// the dual active set.
#include <Eigen/Core>
#include <array>
#include <benchmark/benchmark.h>
#include <string>
#include <vector>

#include "config/qp_file.hpp"
#include "control/qp/dual_active_set.hpp"
#include "control/qp/solver.hpp"
#include "tests/control/random.hpp"

namespace control {
namespace {

// The solver's parts after a solve, all working on one problem.
struct Kernels {
  explicit Kernels(const std::string& name)
      : qp(config::QpFile(LPVMPC_TEST_DATA "/qp/" + name + ".qp").Build()),
        solver(qp.horizon()),
        unconstrained(qp.horizon()),
        bounds(qp.horizon()),
        active_set(qp.horizon(), {}),
        interior_point(qp.horizon(), {}),
        sweep(qp.stages.size()),
        responses(qp.stages.size()) {
    (void)solver.Solve(qp);
    (void)unconstrained.Solve(qp, 1e-8);
    unconstrained.CloseLoop(qp);
    (void)bounds.Shift(qp, unconstrained);
    OcpQpPoint<8, 2> point(qp.horizon());
    unconstrained.Write(qp, point);
    QpResult result;
    (void)active_set.Solve(qp, unconstrained, bounds, nullptr, nullptr, point, result);
    interior_point.BeginRows(qp, bounds);
    interior_point.StartCold(qp);
    (void)interior_point.Residuals(qp);
    (void)interior_point.Factorise(qp);
    interior_point.Step(qp, 0.1, false);
  }
  void DataCheck() { benchmark::DoNotOptimize(HasFiniteData(qp)); }
  void UnconstrainedRecursion() { benchmark::DoNotOptimize(unconstrained.Factorise(qp)); }
  void RecursionWithRows() { benchmark::DoNotOptimize(interior_point.Factorise(qp)); }
  void Sweep() { SweepFromLastStage(sweep); }
  void FourSweeps() { SweepFromLastStage(responses); }
  void RowAssembly() { benchmark::DoNotOptimize(bounds.Shift(qp, unconstrained)); }
  void RowScan() { benchmark::DoNotOptimize(active_set.FindViolated(qp, bounds, nullptr)); }
  void NewtonStepWithItsLength() { interior_point.Step(qp, 0.1, false); }
  void Residuals() { benchmark::DoNotOptimize(interior_point.Residuals(qp)); }
  void KktCheck() { benchmark::DoNotOptimize(EvaluateKkt(qp, solver.solution()).Max()); }

  // Sweeps with a gradient of ones in the last state alone.
  template <typename SweepStages>
  void SweepFromLastStage(SweepStages& stages) {
    detail::ClearGradients(stages.size() - 1, stages);
    stages.back().p.setOnes();
    detail::SweepRiccati(qp, unconstrained.riccati(), stages.size() - 1, stages);
  }

  OcpQp<8, 2> qp;
  OcpQpSolver<8, 2> solver;
  Unconstrained<8, 2> unconstrained;
  ShiftedBounds<8, 2> bounds;
  ActiveSetMethod<8, 2> active_set;
  InteriorPointMethod<8, 2> interior_point;
  std::vector<detail::SweepStage<8, 2, 1>> sweep;
  std::vector<detail::SweepStage<8, 2, 4>> responses;
};

void Kernel(benchmark::State& state, const std::string& name, void (Kernels::*kernel)()) {
  Kernels kernels(name);
  for (auto _ : state) (kernels.*kernel)();
}

#define LPVMPC_KERNEL(kernel)                                              \
  BENCHMARK_CAPTURE(Kernel, N8_##kernel, "s0trN8_0044", &Kernels::kernel); \
  BENCHMARK_CAPTURE(Kernel, N15_##kernel, "s7trN15_0044", &Kernels::kernel)

LPVMPC_KERNEL(DataCheck);
LPVMPC_KERNEL(UnconstrainedRecursion);
LPVMPC_KERNEL(RecursionWithRows);
LPVMPC_KERNEL(Sweep);
LPVMPC_KERNEL(FourSweeps);
LPVMPC_KERNEL(RowAssembly);
LPVMPC_KERNEL(RowScan);
LPVMPC_KERNEL(NewtonStepWithItsLength);
LPVMPC_KERNEL(Residuals);
LPVMPC_KERNEL(KktCheck);

// Argument: number of rows, all of which are active in the end. The time is that of all changes of the working set.
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
