#include "control/mpc/lpv_affine_mpc.hpp"

#include <algorithm>
#include <cmath>

namespace control {

LpvAffineMpc::LpvAffineMpc(const VehicleParameters& vehicle, const RoadProfile& profile,
                           const LpvAffineSettings& settings)
    : vehicle_(vehicle),
      settings_(settings),
      model_(BlendedModel(vehicle), settings.t_s),
      tracking_(vehicle, profile, settings),
      qp_(settings.horizon),
      rows_(qp_),
      solver_(settings.horizon, settings.qp),
      warm_start_(settings.horizon),
      prediction_(settings.horizon),
      trust_region_(settings.trust_radius) {
  const std::size_t N = Index(settings.horizon);
  plan_.z.assign(N + 1, State::Zero());
  plan_.u.assign(N, Input::Zero());
}

void LpvAffineMpc::Reset() {
  prediction_.Clear();
  has_warm_start_ = false;
  trust_region_.Reset();
  tracking_.Reset();
}

bool LpvAffineMpc::SetQpObserver(const QpObserver& observer) {
  qp_observer_ = observer;
  return true;
}

const Plan& LpvAffineMpc::Step(const ControllerInput& input) {
  plan_.iterations = 0;
  plan_.scheduling_error = 0.0;
  plan_.active_trust_rows = 0;
  plan_.largest_slack = 0.0;
  plan_.relaxation = {};
  plan_.manoeuvre.reset();
  // A non-finite input would corrupt the stored passing decisions for good.
  if (!IsFinite(input)) {
    plan_.status = SolverStatus::kNumericalFailure;
    prediction_.Shift();
    return plan_;
  }
  disturbance_ = input.disturbance;
  grip_ = Grip(settings_, input.mu_limit);
  model_ = DiscreteModel(BlendedModel(vehicle_, disturbance_), settings_.t_s);
  tracking_.SetFrictionLimit(input.mu_limit);
  tracking_.Begin(input.z, input.place.s, input.obstacles, input.disturbance, input.slow_down);
  plan_.manoeuvre = tracking_.manoeuvre_status();
  plan_.beyond = tracking_.manoeuvre().path;
  CompareScheduling();
  if (tracking_.waiting()) {
    tracking_.Hold(input.u_previous, plan_.z, plan_.u);
    plan_.status = SolverStatus::kSolved;
    prediction_.Clear();
    has_warm_start_ = false;
  } else {
    Solve(input);
  }
  return plan_;
}

void LpvAffineMpc::CompareScheduling() {
  if (!prediction_.exists()) return;
  plan_.scheduling_error = trust_region_.SchedulingError(tracking_.z(), prediction_.z()[0]);
  if (settings_.adapt_trust_region) trust_region_.Adapt(plan_.scheduling_error);
}

// Solves QPs, each about the plan of the one before. If one fails, the plan before it is kept.
void LpvAffineMpc::Solve(const ControllerInput& input) {
  const int least = prediction_.exists() ? 1 : settings_.first_iterations;
  const int most = std::max(least, settings_.iterations);
  if (prediction_.exists()) {
    prediction_.RollOut(tracking_.z(), model_);
  } else {
    prediction_.Follow(tracking_.z(), tracking_.reference(), tracking_.reference_input());
  }
  for (int k = 0; k < most; ++k) {
    const TimeLeft* time_left = k < least ? nullptr : input.time_left;
    if (time_left != nullptr && !(*time_left)()) break;
    // A row for which the problem has no room must not be ignored: no plan is made.
    const bool built = BuildQp(input.u_previous);
    if (built && qp_observer_) qp_observer_(qp_);
    const QpResult result =
        built ? solver_.Solve(qp_, has_warm_start_ ? &warm_start_ : nullptr, time_left) : QpResult{};
    plan_.iterations += result.iterations;
    if (result.status != SolverStatus::kSolved) {
      if (k == 0) plan_.status = result.status;
      has_warm_start_ = false;
      break;
    }
    plan_.status = result.status;
    has_warm_start_ = result.CanWarmStart();
    if (has_warm_start_) warm_start_ = solver_.solution();
    const double change = ReadPlan();
    prediction_.Set(plan_);
    if (change <= settings_.converged) break;
  }
  prediction_.Shift();
  if (has_warm_start_) warm_start_.Shift();
}

bool LpvAffineMpc::BuildQp(const Input& u_previous) {
  const int N = settings_.horizon;
  const auto z_ref = tracking_.reference();
  const auto u_ref_before = [&](int i) { return tracking_.reference_input()[Index(std::max(i - 1, 0))]; };
  tracking_.BuildConstraints(prediction_.z());
  rows_.Clear();
  qp_.x0 << tracking_.z() - z_ref[0], u_previous - u_ref_before(0);
  for (int i = 0; i <= N; ++i) {
    auto& stage = qp_.stages[Index(i)];
    const double weight = i < N ? 2.0 : 2.0 * settings_.terminal;
    stage.Q << weight * settings_.Q, 2.0 * settings_.R;
    AddInputRows(u_previous, i);
    if (i > 0) {  // the measured state cannot be changed
      AddFrictionRows(i);
      AddBodyRows(i);
      if (settings_.trust_region && prediction_.exists()) AddTrustRegion(i);
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
  return rows_.fits();
}

// Reads plan_ from the solution. Returns the largest change of a scheduling variable, in radii.
double LpvAffineMpc::ReadPlan() {
  const auto& stages = solver_.solution().stages;
  plan_.z[0] = tracking_.z();
  for (std::size_t i = 1; i < plan_.z.size(); ++i) {
    plan_.z[i] = tracking_.reference()[i] + stages[i].x.head<kStates>();
    plan_.u[i - 1] = tracking_.reference_input()[i - 1] + stages[i].x.tail<kInputs>();
  }
  const bool bounded = settings_.trust_region && prediction_.exists();
  MeasureRelaxation();
  return trust_region_.Measure(prediction_, plan_.u.size(), plan_.u.size() - 1, bounded, plan_);
}

void LpvAffineMpc::MeasureRelaxation() {
  plan_.relaxation = {};
  const auto& stages = solver_.solution().stages;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    for (std::size_t j = 0; j < Index(qp_.stages[i].row_count); ++j) {
      const Constraint& constraint = rows_.constraint(i, j);
      if (!qp_.stages[i].rows[j].soft() || constraint.kind == ConstraintKind::kTrust) continue;
      const double slack = stages[i].slack[j];
      if (slack > std::max(plan_.relaxation.amount, kLeastRelaxation)) {
        plan_.relaxation = {.constraint = constraint, .amount = slack};
      }
    }
  }
}

}  // namespace control
