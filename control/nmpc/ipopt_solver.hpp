// Solves a nonlinear program by Ipopt (Wächter, Biegler 2006) with MUMPS. It allocates, and two threads must not
// solve at the same time, since MUMPS is not thread-safe.
//
// Status: kSolved: the tolerance is reached; kInfeasible: Ipopt ended at a local minimum of the constraint violation,
// which is no proof; kIterationLimit: the limit of iterations or time is reached; kNumericalFailure: anything else.
#pragma once

#include <memory>
#include <vector>

#include "control/nmpc/nonlinear_program.hpp"
#include "control/qp/status.hpp"

namespace control {

struct IpoptSettings {
  double tolerance = 1e-4;
  int max_iterations = 100;
  double max_cpu_time = 1e6;  // limit for one solve [s]
  bool scaled = true;  // the program is scaled by its gradients at the start, and the tolerance with it
  double warm_barrier = 1e-4;  // barrier parameter μ at a warm start
  double cold_barrier = 1e-1;  // barrier parameter μ at a cold start
};

// Primal variables x, and dual variables of the bounds of x (z_lo, z_hi) and of the rows (lambda).
struct NonlinearPoint {
  std::vector<double> x, z_lo, z_hi, lambda;
};

class IpoptSolver {
 public:
  struct Result {
    SolverStatus status = SolverStatus::kNumericalFailure;
    int iterations = 0;
  };

  // Throws std::runtime_error if Ipopt refuses its options.
  explicit IpoptSolver(const IpoptSettings& settings);
  ~IpoptSolver();
  IpoptSolver(const IpoptSolver&) = delete;
  IpoptSolver& operator=(const IpoptSolver&) = delete;

  // Solves from `point` and leaves the last iterate there. Without `warm`, only the x of `point` is used.
  Result Solve(const NonlinearProgram& program, NonlinearPoint& point, bool warm);

 private:
  class Application;  // keeps Ipopt's headers in one file
  std::unique_ptr<Application> application_;
};

}  // namespace control
