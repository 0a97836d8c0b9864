#include "control/nmpc.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>

#include "control/halfspace.hpp"
#include "control/nmpc_problem.hpp"

namespace control {
namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr Number kIpoptInfinity = 2e19;  // beyond what Ipopt takes for a bound

std::size_t Size(int n) {
  return static_cast<std::size_t>(n);
}

// Primal and dual variables, in Ipopt's terms.
struct Point {
  std::vector<double> x, z_lo, z_hi, lambda;
};

// The problem as Ipopt asks for it. It starts from `point` and leaves its last iterate there.
class Nlp final : public Ipopt::TNLP {
 public:
  Nlp(const NmpcProblem& problem, Point& point) : problem_(&problem), point_(&point) {}

  bool get_nlp_info(Index& n, Index& m, Index& jacobian_entries, Index& hessian_entries,
                    IndexStyleEnum& style) override {
    n = problem_->variables();
    m = problem_->rows();
    jacobian_entries = static_cast<Index>(problem_->jacobian_pattern().size());
    hessian_entries = static_cast<Index>(problem_->hessian_pattern().size());
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index, Number* x_lo, Number* x_hi, Index, Number* g_lo, Number* g_hi) override {
    const auto copy = [](const NmpcProblem::Bounds& bounds, Number* lo, Number* hi) {
      std::ranges::transform(bounds.lo, lo, [](double b) { return std::max(b, -kIpoptInfinity); });
      std::ranges::transform(bounds.hi, hi, [](double b) { return std::min(b, kIpoptInfinity); });
    };
    copy(problem_->variable_bounds(), x_lo, x_hi);
    copy(problem_->row_bounds(), g_lo, g_hi);
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
    value = problem_->Cost({x, Size(n)});
    return true;
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    problem_->Gradient({x, Size(n)}, {gradient, Size(n)});
    return true;
  }
  bool eval_g(Index n, const Number* x, bool, Index m, Number* g) override {
    problem_->Rows({x, Size(n)}, {g, Size(m)});
    return true;
  }
  bool eval_jac_g(Index n, const Number* x, bool, Index, Index entries, Index* row, Index* column,
                  Number* values) override {
    if (values == nullptr) return CopyPattern(problem_->jacobian_pattern(), row, column);
    problem_->Jacobian({x, Size(n)}, {values, Size(entries)});
    return true;
  }
  bool eval_h(Index n, const Number* x, bool, Number sigma, Index m, const Number* lambda, bool,
              Index entries, Index* row, Index* column, Number* values) override {
    if (values == nullptr) return CopyPattern(problem_->hessian_pattern(), row, column);
    problem_->Hessian({x, Size(n)}, sigma, {lambda, Size(m)}, {values, Size(entries)});
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
  static bool CopyPattern(const std::vector<NmpcProblem::Entry>& pattern, Index* row, Index* column) {
    for (std::size_t k = 0; k < pattern.size(); ++k) {
      row[k] = pattern[k].row;
      column[k] = pattern[k].column;
    }
    return true;
  }

  const NmpcProblem* problem_;
  Point* point_;
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

class Nmpc::Solver {
 public:
  Solver(const VehicleParameters& vehicle, const NmpcSettings& settings)
      : settings_(settings), problem_(vehicle, settings), ipopt_(IpoptApplicationFactory()) {
    plan_.z.assign(Size(settings.horizon) + 1, State::Zero());
    plan_.u.assign(Size(settings.horizon), Input::Zero());
    const auto& options = ipopt_->Options();
    bool set = options->SetIntegerValue("print_level", 0);
    set &= options->SetStringValue("sb", "yes");
    set &= options->SetStringValue("linear_solver", "mumps");
    // Ten times the memory that is needed, as by default, takes time to get.
    set &= options->SetIntegerValue("mumps_mem_percent", 100);
    set &= options->SetNumericValue("tol", settings.tolerance);
    set &= options->SetIntegerValue("acceptable_iter", 0);  // solved to the tolerance or not solved
    set &= options->SetIntegerValue("max_iter", settings.max_iterations);
    set &= options->SetNumericValue("max_cpu_time", settings.max_cpu_time);
    set &= options->SetNumericValue("warm_start_bound_push", 1e-6);
    set &= options->SetNumericValue("warm_start_mult_bound_push", 1e-6);
    // "": an ipopt.opt that happens to lie in the working directory has no say.
    if (!set || ipopt_->Initialize("") != Ipopt::Solve_Succeeded) {
      throw std::runtime_error("Ipopt refuses its options: is it built with MUMPS?");
    }
  }

  [[nodiscard]] int horizon() const { return settings_.horizon; }
  void Reset() { has_guess_ = false; }

  const Plan& Step(const ControllerInput& input) {
    problem_.Set(input);
    if (!has_guess_) StartFromReference(input);
    MoveOutOfObstacles(input);
    const bool warm = has_guess_ && point_.lambda.size() == Size(problem_.rows());
    ipopt_->Options()->SetStringValue("warm_start_init_point", warm ? "yes" : "no");
    ipopt_->Options()->SetNumericValue("mu_init", warm ? 1e-4 : 1e-1);
    const Ipopt::SmartPtr<Ipopt::TNLP> nlp = new Nlp(problem_, point_);
    plan_.status = FromIpopt(ipopt_->OptimizeTNLP(nlp));
    const auto statistics = ipopt_->Statistics();
    plan_.iterations = Ipopt::IsValid(statistics) ? statistics->IterationCount() : 0;
    for (std::size_t i = 0; i < plan_.z.size(); ++i) {
      plan_.z[i] = problem_.StateOf(point_.x, static_cast<int>(i));
      if (i < plan_.u.size()) plan_.u[i] = problem_.InputOf(point_.x, static_cast<int>(i));
    }
    last_ = point_.x;
    has_guess_ = plan_.status == SolverStatus::kSolved;
    if (has_guess_) Shift();
    return plan_;
  }

  [[nodiscard]] std::optional<ConstraintViolation> Unsatisfied() const {
    if (last_.size() != Size(problem_.variables())) return std::nullopt;
    const ConstraintViolation largest = problem_.LargestViolation(problem_.Driven(last_));
    if (!(largest.amount > settings_.tolerance)) return std::nullopt;
    return largest;
  }

 private:
  void StartFromReference(const ControllerInput& input) {
    point_ = {};
    point_.x.assign(Size(problem_.variables()), 0.0);
    for (int i = 1; i <= horizon(); ++i) {
      std::ranges::copy(input.reference[Size(i)], point_.x.begin() + NmpcProblem::StateAt(i));
    }
  }

  void MoveOutOfObstacles(const ControllerInput& input) {
    for (int i = 1; i <= horizon(); ++i) {
      double* const z = point_.x.data() + NmpcProblem::StateAt(i);
      for (const Obstacle& obstacle : input.obstacles) {
        State at = problem_.StateOf(point_.x, i);
        at[kPsi] = input.reference[Size(i)][kPsi];  // the way out is across the road
        const auto outside = ObstacleHalfSpace(obstacle, at, settings_.obstacle_margin);
        if (!outside) continue;
        const double distance = outside->c - outside->a * at[kX] - outside->b * at[kY];
        z[kX] += distance * outside->a;
        z[kY] += distance * outside->b;
      }
    }
  }

  // Each step takes what the next one had. The last one keeps its own inputs and multipliers, and goes on by the model.
  void Shift() {
    const State z_N = problem_.StateOf(point_.x, horizon());
    const Input u_N = problem_.InputOf(point_.x, horizon() - 1);
    for (std::vector<double>* values : {&point_.x, &point_.z_lo, &point_.z_hi, &point_.lambda}) {
      const auto step = static_cast<std::ptrdiff_t>(values->size()) / horizon();
      std::copy(values->begin() + step, values->end(), values->begin());
    }
    std::ranges::copy(problem_.Next(z_N, u_N), point_.x.begin() + NmpcProblem::StateAt(horizon()));
  }

  NmpcSettings settings_;
  NmpcProblem problem_;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt_;
  Point point_;               // where the next solve starts
  bool has_guess_ = false;    // point_ comes from the last solution
  std::vector<double> last_;  // x at the end of the last solve
  Plan plan_;
};

Nmpc::Nmpc(const VehicleParameters& vehicle, const NmpcSettings& settings)
    : solver_(std::make_unique<Solver>(vehicle, settings)) {}
Nmpc::~Nmpc() = default;

int Nmpc::horizon() const {
  return solver_->horizon();
}

const Plan& Nmpc::Step(const ControllerInput& input) {
  return solver_->Step(input);
}

void Nmpc::Reset() {
  solver_->Reset();
}

std::optional<ConstraintViolation> Nmpc::Unsatisfied() const {
  return solver_->Unsatisfied();
}

}  // namespace control
