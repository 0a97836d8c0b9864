#include "control/nmpc/ipopt_solver.hpp"

#include <algorithm>
#include <stdexcept>

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>

namespace control {
namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr Number kIpoptInfinity = 2e19;  // beyond what Ipopt treats as a bound

std::size_t Size(int n) {
  return static_cast<std::size_t>(n);
}

// The program in the form that Ipopt requires. It starts from `point` and leaves its last iterate there.
class Nlp final : public Ipopt::TNLP {
 public:
  Nlp(const NonlinearProgram& program, NonlinearPoint& point) : program_(&program), point_(&point) {}

  bool get_nlp_info(Index& n, Index& m, Index& jacobian_entries, Index& hessian_entries,
                    IndexStyleEnum& style) override {
    n = program_->variables();
    m = program_->rows();
    jacobian_entries = static_cast<Index>(program_->jacobian_pattern().size());
    hessian_entries = static_cast<Index>(program_->hessian_pattern().size());
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index, Number* x_lo, Number* x_hi, Index, Number* g_lo, Number* g_hi) override {
    const auto copy = [](const NonlinearProgram::Bounds& bounds, Number* lo, Number* hi) {
      std::ranges::transform(bounds.lo, lo, [](double b) { return std::max(b, -kIpoptInfinity); });
      std::ranges::transform(bounds.hi, hi, [](double b) { return std::min(b, kIpoptInfinity); });
    };
    copy(program_->variable_bounds(), x_lo, x_hi);
    copy(program_->row_bounds(), g_lo, g_hi);
    return true;
  }
  bool get_starting_point(Index, bool, Number* x, bool with_z, Number* z_lo, Number* z_hi, Index,
                          bool with_lambda, Number* lambda) override {
    std::ranges::copy(point_->x, x);
    if (with_z) {
      std::ranges::copy(point_->z_lo, z_lo);
      std::ranges::copy(point_->z_hi, z_hi);
    }
    if (with_lambda) std::ranges::copy(point_->lambda, lambda);
    return true;
  }
  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    value = program_->Cost({x, Size(n)});
    return true;
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    program_->Gradient({x, Size(n)}, {gradient, Size(n)});
    return true;
  }
  bool eval_g(Index n, const Number* x, bool, Index m, Number* g) override {
    program_->Rows({x, Size(n)}, {g, Size(m)});
    return true;
  }
  bool eval_jac_g(Index n, const Number* x, bool, Index, Index entries, Index* row, Index* column,
                  Number* values) override {
    if (values == nullptr) return CopyPattern(program_->jacobian_pattern(), row, column);
    program_->Jacobian({x, Size(n)}, {values, Size(entries)});
    return true;
  }
  bool eval_h(Index n, const Number* x, bool, Number sigma, Index m, const Number* lambda, bool,
              Index entries, Index* row, Index* column, Number* values) override {
    if (values == nullptr) return CopyPattern(program_->hessian_pattern(), row, column);
    program_->Hessian({x, Size(n)}, sigma, {lambda, Size(m)}, {values, Size(entries)});
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number* z_lo,
                         const Number* z_hi, Index m, const Number*, const Number* lambda, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    point_->x.assign(x, x + n);
    point_->z_lo.assign(z_lo, z_lo + n);
    point_->z_hi.assign(z_hi, z_hi + n);
    point_->lambda.assign(lambda, lambda + m);
  }

 private:
  static bool CopyPattern(const std::vector<NonlinearProgram::Entry>& pattern, Index* row, Index* column) {
    for (std::size_t k = 0; k < pattern.size(); ++k) {
      row[k] = pattern[k].row;
      column[k] = pattern[k].column;
    }
    return true;
  }

  const NonlinearProgram* program_;
  NonlinearPoint* point_;
};

SolverStatus FromIpopt(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return SolverStatus::kSolved;
    case Ipopt::Infeasible_Problem_Detected:
      return SolverStatus::kInfeasible;
    case Ipopt::Maximum_Iterations_Exceeded:
    case Ipopt::Maximum_CpuTime_Exceeded:
      return SolverStatus::kIterationLimit;
    default:
      return SolverStatus::kNumericalFailure;
  }
}

}  // namespace

class IpoptSolver::Application {
 public:
  explicit Application(const IpoptSettings& settings)
      : settings_(settings), ipopt_(IpoptApplicationFactory()) {
    const auto& options = ipopt_->Options();
    bool set = options->SetIntegerValue("print_level", 0);
    set &= options->SetStringValue("sb", "yes");
    set &= options->SetStringValue("linear_solver", "mumps");
    // The default, ten times the memory that is needed, takes time to allocate.
    set &= options->SetIntegerValue("mumps_mem_percent", 100);
    set &= options->SetNumericValue("tol", settings.tolerance);
    set &= options->SetIntegerValue("acceptable_iter", 0);  // solved to the tolerance or not solved
    set &= options->SetIntegerValue("max_iter", settings.max_iterations);
    set &= options->SetNumericValue("max_cpu_time", settings.max_cpu_time);
    set &= options->SetStringValue("nlp_scaling_method", settings.scaled ? "gradient-based" : "none");
    set &= options->SetNumericValue("warm_start_bound_push", 1e-6);
    set &= options->SetNumericValue("warm_start_mult_bound_push", 1e-6);
    // "": an ipopt.opt that happens to be in the working directory is ignored.
    if (!set || ipopt_->Initialize("") != Ipopt::Solve_Succeeded) {
      throw std::runtime_error("Ipopt refuses its options: is it built with MUMPS?");
    }
  }

  Result Solve(const NonlinearProgram& program, NonlinearPoint& point, bool warm) {
    ipopt_->Options()->SetStringValue("warm_start_init_point", warm ? "yes" : "no");
    ipopt_->Options()->SetNumericValue("mu_init", warm ? settings_.warm_barrier : settings_.cold_barrier);
    const Ipopt::SmartPtr<Ipopt::TNLP> nlp = new Nlp(program, point);
    const SolverStatus status = FromIpopt(ipopt_->OptimizeTNLP(nlp));
    const auto statistics = ipopt_->Statistics();
    return {.status = status, .iterations = Ipopt::IsValid(statistics) ? statistics->IterationCount() : 0};
  }

 private:
  IpoptSettings settings_;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt_;
};

IpoptSolver::IpoptSolver(const IpoptSettings& settings)
    : application_(std::make_unique<Application>(settings)) {}
IpoptSolver::~IpoptSolver() = default;

IpoptSolver::Result IpoptSolver::Solve(const NonlinearProgram& program, NonlinearPoint& point, bool warm) {
  return application_->Solve(program, point, warm);
}

}  // namespace control
