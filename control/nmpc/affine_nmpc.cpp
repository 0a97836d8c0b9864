#include "control/nmpc/affine_nmpc.hpp"

#include <algorithm>
#include <cmath>

namespace control {

AffineNmpc::AffineNmpc(const VehicleParameters& vehicle, const RoadProfile& profile,
                       const LpvAffineSettings& problem, const AffineNmpcSettings& settings)
    : settings_(settings),
      trust_region_(problem.trust_radius),
      tracking_(vehicle, profile, problem),
      problem_(vehicle, problem),
      // No scaling: the penalties would scale the cost down and change the unit of the tolerance. With penalties this
      // large, a small μ at a cold start takes up to four times the iterations.
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
  prediction_.Clear();
  has_duals_ = false;
  tracking_.Reset();
}

const Plan& AffineNmpc::Step(const ControllerInput& input) {
  plan_.iterations = 0;
  plan_.relaxation = {};
  plan_.manoeuvre.reset();
  // A non-finite input would corrupt the passing decisions for good.
  if (!IsFinite(input)) {
    plan_.status = SolverStatus::kNumericalFailure;
    prediction_.Shift();
    return plan_;
  }
  tracking_.SetFrictionLimit(input.mu_limit);
  tracking_.Begin(input.z, input.place.s, input.obstacles, input.disturbance, input.slow_down);
  plan_.manoeuvre = tracking_.manoeuvre_status();
  if (tracking_.waiting()) {
    tracking_.Hold(input.u_previous, plan_.z, plan_.u);
    plan_.status = SolverStatus::kSolved;
    prediction_.Clear();
    has_duals_ = false;
  } else {
    Solve(input);
  }
  return plan_;
}

// Solves in rounds; a round that fails leaves the previous plan in place.
void AffineNmpc::Solve(const ControllerInput& input) {
  if (prediction_.exists()) {
    prediction_.RollOut(tracking_.z(), problem_.ModelWith(input.disturbance));
  } else {
    prediction_.Follow(tracking_.z(), tracking_.reference(), tracking_.reference_input());
  }
  for (int round = 0; round < settings_.rounds; ++round) {
    tracking_.BuildConstraints(prediction_.z());
    const AffineNmpcProblem last = problem_;
    problem_.Set(tracking_, input.u_previous, input.disturbance, input.mu_limit);
    point_ = Start(last, round == 0 ? 1 : 0);
    const IpoptSolver::Result result = solver_.Solve(problem_, point_, has_duals_);
    plan_.iterations += result.iterations;
    has_duals_ = result.status == SolverStatus::kSolved;
    if (round == 0 || has_duals_) plan_.status = result.status;
    if (!has_duals_) break;
    const double change = ReadPlan();
    prediction_.Set(plan_);
    if (change <= settings_.converged) break;
  }
  prediction_.Shift();
}

// Warm start: the prediction with the multipliers of the last solution, of which each step takes those of the step
// `shift` later. A new body row has none yet.
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
      int match = from;  // identical rows keep their order
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
  plan_.z[0] = tracking_.z();
  for (std::size_t i = 1; i < plan_.z.size(); ++i) {
    plan_.z[i] = problem_.StateOf(point_.x, static_cast<int>(i));
    plan_.u[i - 1] = problem_.InputOf(point_.x, static_cast<int>(i) - 1);
  }
  MeasureRelaxation();
  return trust_region_.Measure(prediction_, plan_.u.size(), plan_.u.size() - 1, false, plan_);
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
