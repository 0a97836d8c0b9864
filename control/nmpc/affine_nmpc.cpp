#include "control/nmpc/affine_nmpc.hpp"

#include <algorithm>
#include <cmath>

#include "control/mpc/lpv_affine_terms.hpp"

namespace control {

using namespace lpv_affine;

AffineNmpc::AffineNmpc(const VehicleParameters& vehicle, const RoadProfile& course,
                       const LpvAffineSettings& problem, const AffineNmpcSettings& settings)
    : settings_(settings),
      radii_(problem.trust_radius),
      model_(BlendedModel(vehicle), problem.t_s),
      task_(vehicle, course, problem),
      problem_(vehicle, problem),
      // Unscaled: penalties would scale the cost down, and make the tolerance that of another unit.
      // Where penalties are that large, a small μ at a cold start takes up to four times the iterations.
      solver_({.tolerance = settings.tolerance,
               .max_iterations = settings.max_iterations,
               .scaled = false,
               .cold_barrier = 100.0}),
      prediction_(problem.horizon) {
  const std::size_t N = Index(problem.horizon);
  plan_.z.assign(N + 1, State::Zero());
  plan_.u.assign(N, Input::Zero());
}

void AffineNmpc::Reset() {
  prediction_.Drop();
  has_duals_ = false;
  task_.Reset();
}

const Plan& AffineNmpc::Step(const ControllerInput& input) {
  plan_.iterations = 0;
  plan_.relaxation = {};
  // A place on the course or a side that comes of such a value would be one by chance, and stay.
  if (!IsFinite(input)) {
    plan_.status = SolverStatus::kNumericalFailure;
    prediction_.Shift();
    return plan_;
  }
  task_.Begin(input.z, input.obstacles);
  if (task_.waiting()) {
    task_.Hold(input.u_previous, plan_.z, plan_.u);
    plan_.status = SolverStatus::kSolved;
    prediction_.Drop();
    has_duals_ = false;
  } else {
    Solve(input.u_previous);
  }
  return plan_;
}

// A round that fails leaves the plan before it.
void AffineNmpc::Solve(const Input& u_previous) {
  prediction_.Begin(task_, model_);
  for (int round = 0; round < settings_.rounds; ++round) {
    SolverStatus status = SolverStatus::kNumericalFailure;
    // An obstacle that finds no room in the problem must not be ignored.
    if (task_.Bound(prediction_.z())) {
      const AffineNmpcProblem last = problem_;
      problem_.Set(task_, u_previous);
      point_ = Start(last, round == 0 ? 1 : 0);
      const IpoptSolver::Result result = solver_.Solve(problem_, point_, has_duals_);
      plan_.iterations += result.iterations;
      status = result.status;
    }
    has_duals_ = status == SolverStatus::kSolved;
    if (round == 0 || has_duals_) plan_.status = status;
    if (!has_duals_) break;
    const double change = ReadPlan();
    prediction_.Take(plan_);
    if (change <= settings_.converged) break;
  }
  prediction_.Shift();
}

// The prediction, with the multipliers of the last solution, of which each step takes those that the step `shift` later
// had. A row of the body that was not there has none yet.
NonlinearPoint AffineNmpc::Start(const AffineNmpcProblem& last, int shift) const {
  NonlinearPoint start{
      .x = problem_.PointOf(prediction_.z(), prediction_.u()), .z_lo = {}, .z_hi = {}, .lambda = {}};
  if (!has_duals_) return start;
  start.z_lo.assign(start.x.size(), 0.0);
  start.z_hi.assign(start.x.size(), 0.0);
  start.lambda.assign(Index(problem_.rows()), 0.0);
  const auto copy = [](const std::vector<double>& from, int at, std::vector<double>& to, int where,
                       int count) { std::copy_n(from.begin() + at, count, to.begin() + where); };
  for (int i = 1; i <= horizon(); ++i) {
    const int j = std::min(i + shift, horizon());  // the last step keeps its own
    copy(point_.z_lo, last.InputAt(j - 1), start.z_lo, problem_.InputAt(i - 1), kInputs);
    copy(point_.z_hi, last.InputAt(j - 1), start.z_hi, problem_.InputAt(i - 1), kInputs);
    copy(point_.lambda, last.RowAt(j - 1), start.lambda, problem_.RowAt(i - 1), kStates + kInputs);
    int from = 0;
    for (int soft = 0; soft < problem_.SoftRows(i); ++soft) {
      const int slack = problem_.SlackAt(i, soft);
      const Constraint wanted = problem_.SoftConstraint(i, soft);
      const auto is_wanted = [&](int k) {
        const Constraint constraint = last.SoftConstraint(j, k);
        return constraint.kind == wanted.kind && constraint.index == wanted.index;
      };
      int match = from;  // rows that are alike come in the same order
      while (match < last.SoftRows(j) && !is_wanted(match)) ++match;
      if (match < last.SoftRows(j)) {
        copy(point_.z_lo, last.SlackAt(j, match), start.z_lo, slack, 2);
        start.lambda[Index(problem_.SoftRowAt(i, soft))] = point_.lambda[Index(last.SoftRowAt(j, match))];
        from = match + 1;
      } else {
        std::fill_n(start.z_lo.begin() + slack, 2, problem_.Penalty(i, soft));
      }
    }
  }
  return start;
}

// Returns the largest change of a scheduling variable against the prediction, in radii.
double AffineNmpc::ReadPlan() {
  double change = 0.0;
  const auto measure = [&](double value, double predicted, std::size_t j) {
    change = std::max(change, std::abs(value - predicted) / radii_[static_cast<Eigen::Index>(j)]);
  };
  plan_.z[0] = task_.z();
  for (std::size_t i = 1; i < plan_.z.size(); ++i) {
    plan_.z[i] = problem_.StateOf(point_.x, static_cast<int>(i));
    plan_.u[i - 1] = problem_.InputOf(point_.x, static_cast<int>(i) - 1);
  }
  prediction_.Compare(plan_, measure);
  MeasureRelaxation();
  return change;
}

void AffineNmpc::MeasureRelaxation() {
  plan_.relaxation = {};
  for (int i = 1; i <= horizon(); ++i) {
    for (int soft = 0; soft < problem_.SoftRows(i); ++soft) {
      const double slack = problem_.Slack(point_.x, i, soft);
      if (slack > std::max(plan_.relaxation.amount, kLeastRelaxation)) {
        plan_.relaxation = {.constraint = problem_.SoftConstraint(i, soft), .amount = slack};
      }
    }
  }
}

}  // namespace control
