#include "control/mpc/lpv_affine_mpc.hpp"

#include <algorithm>
#include <cmath>

#include "control/mpc/lpv_affine_terms.hpp"

namespace control {

using namespace lpv_affine;

LpvAffineMpc::LpvAffineMpc(const VehicleParameters& vehicle, const RoadProfile& course,
                           const LpvAffineSettings& settings)
    : settings_(settings),
      model_(BlendedModel(vehicle), settings.t_s),
      task_(vehicle, course, settings),
      qp_(settings.horizon),
      solver_(settings.horizon, settings.qp),
      guess_(settings.horizon),
      constraints_(Index(settings.horizon) + 1),
      prediction_(settings.horizon) {
  const std::size_t N = Index(settings.horizon);
  plan_.z.assign(N + 1, State::Zero());
  plan_.u.assign(N, Input::Zero());
}

void LpvAffineMpc::Reset() {
  prediction_.Drop();
  has_guess_ = false;
  trust_scale_ = 1.0;
  task_.Reset();
}

bool LpvAffineMpc::SetQpObserver(const QpObserver& observer) {
  show_qp_ = observer;
  return true;
}

const Plan& LpvAffineMpc::Step(const ControllerInput& input) {
  plan_.iterations = 0;
  plan_.scheduling_error = 0.0;
  plan_.active_trust_rows = 0;
  plan_.largest_slack = 0.0;
  plan_.relaxation = {};
  // A place on the course or a side that comes of such a value would be one by chance, and stay.
  if (!IsFinite(input)) {
    plan_.status = SolverStatus::kNumericalFailure;
    prediction_.Shift();
    return plan_;
  }
  task_.Begin(input.z, input.obstacles);
  CompareScheduling();
  if (task_.waiting()) {
    task_.Hold(input.u_previous, plan_.z, plan_.u);
    plan_.status = SolverStatus::kSolved;
    prediction_.Drop();
    has_guess_ = false;
  } else {
    Solve(input);
  }
  return plan_;
}

// Scheduling realised against predicted. Where predictions come true the trust region may be wide; where they do not,
// the model about them deserves less trust.
void LpvAffineMpc::CompareScheduling() {
  constexpr double kPoor = 0.5, kGood = 0.25;      // of the present radii
  constexpr double kNarrower = 0.8, kWider = 1.1;  // per step
  constexpr double kNarrowest = 0.5, kWidest = 2.0;
  if (!prediction_.exists()) return;
  for (std::size_t j = 0; j < kScheduledStates.size(); ++j) {
    const double error = std::abs(task_.z()[kScheduledStates[j]] - prediction_.z()[0][kScheduledStates[j]]);
    const double radius = settings_.trust_radius[static_cast<Eigen::Index>(j)];
    plan_.scheduling_error = std::max(plan_.scheduling_error, error / radius);
  }
  if (!settings_.adapt_trust_region) return;
  const double mismatch = plan_.scheduling_error / trust_scale_;
  const double factor = mismatch > kPoor ? kNarrower : (mismatch < kGood ? kWider : 1.0);
  trust_scale_ = std::clamp(factor * trust_scale_, kNarrowest, kWidest);
}

// QPs, each about the plan of the one before. One that fails leaves the plan before it.
void LpvAffineMpc::Solve(const ControllerInput& input) {
  const int least = prediction_.exists() ? 1 : settings_.first_iterations;
  const int most = std::max(least, settings_.iterations);
  prediction_.Begin(task_, model_);
  for (int k = 0; k < most; ++k) {
    const TimeLeft* time_left = k < least ? nullptr : input.time_left;
    if (time_left != nullptr && !(*time_left)()) break;
    // An obstacle that finds no room in the problem must not be ignored.
    const bool built = BuildQp(input.u_previous);
    if (built && show_qp_) show_qp_(qp_);
    const QpResult result =
        built ? solver_.Solve(qp_, has_guess_ ? &guess_ : nullptr, time_left) : QpResult{};
    plan_.iterations += result.iterations;
    if (result.status != SolverStatus::kSolved) {
      if (k == 0) plan_.status = result.status;
      has_guess_ = false;
      break;
    }
    plan_.status = result.status;
    has_guess_ = result.MakesGuess();
    if (has_guess_) guess_ = solver_.solution();
    const double change = ReadPlan();
    prediction_.Take(plan_);
    if (change <= settings_.converged) break;
  }
  prediction_.Shift();
  if (has_guess_) guess_.Shift();
}

bool LpvAffineMpc::BuildQp(const Input& u_previous) {
  const int N = settings_.horizon;
  const auto z_ref = task_.reference();
  const auto u_ref_before = [&](int i) { return task_.reference_input()[Index(std::max(i - 1, 0))]; };
  bool fits = task_.Bound(prediction_.z());
  qp_.x0 << task_.z() - z_ref[0], u_previous - u_ref_before(0);
  for (int i = 0; i <= N; ++i) {
    auto& stage = qp_.stages[Index(i)];
    const double weight = i < N ? 2.0 : 2.0 * settings_.terminal;
    stage.Q << weight * settings_.Q, 2.0 * settings_.R;
    stage.ClearRows();
    fits &= AddInputRows(u_previous, i);
    if (i > 0) {  // the measured state cannot be changed
      fits &= AddFrictionRows(i);
      fits &= AddBodyRows(i);
      if (settings_.trust_region && prediction_.exists()) fits &= AddTrustRegion(i);
    }
    if (i == N) break;
    const AffineModel model = model_.Expand(prediction_.z()[Index(i)], prediction_.u()[Index(i)]);
    stage.A.setIdentity();
    stage.A.topLeftCorner<kStates, kStates>() = model.linear.A;
    stage.A.topRightCorner<kStates, kInputs>() = model.linear.B;
    stage.B.topRows<kStates>() = model.linear.B;
    stage.B.bottomRows<kInputs>().setIdentity();
    stage.c.head<kStates>() =
        model.linear.A * z_ref[Index(i)] + model.linear.B * u_ref_before(i) + model.c - z_ref[Index(i) + 1];
    stage.c.tail<kInputs>() = u_ref_before(i) - u_ref_before(i + 1);
    stage.R = 2.0 * settings_.R_rate;
  }
  return fits;
}

// Returns the largest change of a scheduling variable, in radii.
double LpvAffineMpc::ReadPlan() {
  const auto& stages = solver_.solution().stages;
  double change = 0.0;
  plan_.active_trust_rows = 0;
  plan_.largest_slack = 0.0;
  const bool bounded = settings_.trust_region && prediction_.exists();
  const auto measure = [&](double value, double predicted, std::size_t j) {
    const double deviation =
        std::abs(value - predicted) / settings_.trust_radius[static_cast<Eigen::Index>(j)];
    change = std::max(change, deviation);
    if (!bounded) return;
    if (deviation >= trust_scale_ * (1.0 - 1e-6)) ++plan_.active_trust_rows;
    plan_.largest_slack = std::max(plan_.largest_slack, deviation / trust_scale_ - 1.0);
  };
  plan_.z[0] = task_.z();
  for (std::size_t i = 1; i < plan_.z.size(); ++i) {
    plan_.z[i] = task_.reference()[i] + stages[i].x.head<kStates>();
    plan_.u[i - 1] = task_.reference_input()[i - 1] + stages[i].x.tail<kInputs>();
  }
  prediction_.Compare(plan_, measure);
  MeasureRelaxation();
  return change;
}

void LpvAffineMpc::MeasureRelaxation() {
  plan_.relaxation = {};
  const auto& stages = solver_.solution().stages;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    for (std::size_t j = 0; j < Index(qp_.stages[i].row_count); ++j) {
      const Constraint& constraint = constraints_[i][j];
      if (!qp_.stages[i].rows[j].soft() || constraint.kind == ConstraintKind::kTrust) continue;
      const double slack = stages[i].slack[j];
      if (slack > std::max(plan_.relaxation.amount, kLeastRelaxation)) {
        plan_.relaxation = {.constraint = constraint, .amount = slack};
      }
    }
  }
}

}  // namespace control
