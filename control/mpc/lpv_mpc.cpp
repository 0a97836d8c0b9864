#include "control/mpc/lpv_mpc.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "control/road/halfspace.hpp"
#include "control/vehicle/geometry.hpp"

namespace control {
LpvMpc::LpvMpc(const VehicleParameters& vehicle, const LpvMpcSettings& settings)
    : settings_(settings),
      model_(vehicle),
      qp_(settings.horizon),
      rows_(qp_),
      solver_(settings.horizon, settings.qp),
      elastic_(settings.horizon),
      elastic_solver_(settings.horizon, settings.qp),
      warm_start_(settings.horizon),
      prediction_(settings.horizon),
      trust_region_(settings.trust_radius) {
  plan_.z.assign(Index(settings.horizon) + 1, State::Zero());
  plan_.u.assign(Index(settings.horizon), Input::Zero());
}

void LpvMpc::Reset() {
  prediction_.Clear();
  has_warm_start_ = false;
}

bool LpvMpc::SetQpObserver(const QpObserver& observer) {
  qp_observer_ = observer;
  return true;
}

const Plan& LpvMpc::Step(const TrackingInput& input) {
  assert(input.reference.size() == plan_.z.size());
  plan_.scheduling_error = 0.0;
  if (prediction_.exists()) {
    plan_.scheduling_error = trust_region_.SchedulingError(input.z, prediction_.z()[0]);
  } else {
    prediction_.Hold(input.z, input.u_previous);  // paper, alg:LPVMPC, line 1: p̂_{i|0} = (υ₀, ν₀, δ₀, ψ₀)
  }
  BuildQp(input);
  if (qp_observer_) qp_observer_(qp_);
  const QpResult result = solver_.Solve(qp_, has_warm_start_ ? &warm_start_ : nullptr);
  plan_.status = result.status;
  plan_.iterations = result.iterations;
  ReadPlan(input);
  has_warm_start_ = result.CanWarmStart();
  if (has_warm_start_) {
    warm_start_ = solver_.solution();
    warm_start_.Shift();
  }
  PredictNext();
  return plan_;
}

void LpvMpc::BuildQp(const TrackingInput& input) {
  const int N = settings_.horizon;
  qp_.x0 << input.z - input.reference[0], input.u_previous;
  rows_.Clear();
  for (int i = 0; i <= N; ++i) {
    auto& stage = qp_.stages[Index(i)];
    stage.Q.head<kStates>() = 2.0 * (i < N ? settings_.Q : settings_.P);
    AddRows(input, i);
    if (i == N) break;
    const State& z_hat = prediction_.z()[Index(i)];
    const Scheduling p_hat{.upsilon = z_hat[kUpsilon],
                           .nu = z_hat[kNu],
                           .delta = prediction_.u()[Index(i)][kDelta],
                           .psi = z_hat[kPsi]};
    const LinearModel model = model_.Discrete(p_hat, settings_.t_s, settings_.discretisation);
    stage.A.topLeftCorner<kStates, kStates>() = model.A;
    stage.B.topRows<kStates>() = model.B;
    stage.B.bottomRows<kInputs>().setIdentity();
    stage.c.head<kStates>() = model.A * input.reference[Index(i)] - input.reference[Index(i) + 1];
    stage.R = 2.0 * settings_.R;
  }
}

// The order of rows is the same in every stage before N, so that multipliers can be passed from one stage to another:
// inputs, trust region of the steering angle, states, road, trust region of the states, obstacles. (Stage 0 has only
// the first two.)
void LpvMpc::AddRows(const TrackingInput& input, int i) {
  const bool bounded = settings_.trust_region && prediction_.exists() && i < settings_.horizon;
  if (i < settings_.horizon) AddInputRows(i);
  if (bounded) AddSteeringTrust(i);
  if (i > 0) {  // the measured state cannot be changed
    AddStateRows(input, i);
    if (bounded) AddStateTrust(input.reference[Index(i)], i);
    AddObstacleRows(input, i);
  }
  // An obstacle for which there is no room must not be ignored: an unsatisfiable row makes the problem infeasible.
  if (!rows_.fits())
    qp_.stages[Index(i)].rows.back() = {.C = QpState::Zero(), .D = Input::Zero(), .lo = 1.0, .hi = kNoBound};
}

void LpvMpc::AddInputRows(int i) {
  for (int j = 0; j < kInputs; ++j) {
    rows_.AddInputBound({.kind = ConstraintKind::kInput, .index = j, .step = i}, j, settings_.u_min[j],
                        settings_.u_max[j]);
    const QpState C = -QpState::Unit(kPreviousInput + j);
    rows_.AddRow({.kind = ConstraintKind::kRate, .index = j, .step = i}, C, Input::Unit(j),
                 -settings_.rate_max[j], settings_.rate_max[j]);
  }
}

void LpvMpc::AddStateRows(const TrackingInput& input, int i) {
  const State& z_ref = input.reference[Index(i)];
  for (int j = 0; j < kStates; ++j) {
    const double origin = j == kPsi ? 0.0 : z_ref[j];
    rows_.AddStateBound({.kind = ConstraintKind::kState, .index = j, .step = i}, j,
                        settings_.z_min[j] - origin, settings_.z_max[j] - origin);
  }
  QpState normal = QpState::Zero();
  normal.segment<2>(kX) = LeftOf(z_ref[kPsi]);
  const RoadBounds& road = input.road[Index(i)];
  rows_.AddRow({.kind = ConstraintKind::kRoad, .index = 0, .step = i}, normal, Input::Zero(), road.right,
               road.left);
}

void LpvMpc::AddSteeringTrust(int i) {
  const double delta_hat = prediction_.u()[Index(i)][kDelta];
  const double e = trust_region_.Radius(kScheduledDelta);
  rows_.AddInputBound({.kind = ConstraintKind::kTrust, .index = kStates + kDelta, .step = i}, kDelta,
                      delta_hat - e, delta_hat + e, {.rho = 2.0 * settings_.E_p[kScheduledDelta]});
}

void LpvMpc::AddStateTrust(const State& z_ref, int i) {
  for (std::size_t j = 0; j < kScheduledStates.size(); ++j) {
    const int x = kScheduledStates[j];
    const double z_hat = prediction_.z()[Index(i)][x] - z_ref[x];
    const double e = trust_region_.Radius(j);
    rows_.AddStateBound({.kind = ConstraintKind::kTrust, .index = x, .step = i}, x, z_hat - e, z_hat + e,
                        {.rho = 2.0 * settings_.E_p[static_cast<Eigen::Index>(j)]});
  }
}

void LpvMpc::AddObstacleRows(const TrackingInput& input, int i) {
  const State& z_ref = input.reference[Index(i)];
  for (const Obstacle& obstacle : input.obstacles) {
    const auto halfspace = ObstacleHalfSpace(obstacle, z_ref, settings_.obstacle_margin);
    if (!halfspace) continue;
    QpState C = QpState::Zero();
    C[kX] = halfspace->a;
    C[kY] = halfspace->b;
    const double lo = halfspace->c - halfspace->a * z_ref[kX] - halfspace->b * z_ref[kY];
    rows_.AddRow({.kind = ConstraintKind::kObstacle, .index = obstacle.id, .step = i}, C, Input::Zero(), lo,
                 kNoBound);
  }
}

std::optional<ConstraintViolation> LpvMpc::DiagnoseInfeasibility() const {
  constexpr double kPenalty = 1e6;  // other costs are about 1 to 100: the violation is almost the least
  const auto holds_state = [](const Constraint& constraint) {
    return constraint.kind == ConstraintKind::kState || constraint.kind == ConstraintKind::kRoad ||
           constraint.kind == ConstraintKind::kObstacle;
  };
  const auto is_relaxed = [&](std::size_t i, std::size_t j) {
    return !qp_.stages[i].rows[j].soft() && holds_state(rows_.constraint(i, j));
  };
  elastic_ = qp_;
  for (std::size_t i = 0; i < elastic_.stages.size(); ++i) {
    auto& stage = elastic_.stages[i];
    for (std::size_t j = 0; j < Index(stage.row_count); ++j) {
      if (is_relaxed(i, j)) stage.rows[j].rho = kPenalty;
    }
  }
  if (elastic_solver_.Solve(elastic_).status != SolverStatus::kSolved) return std::nullopt;
  ConstraintViolation largest;
  for (std::size_t i = 0; i < elastic_.stages.size(); ++i) {
    for (std::size_t j = 0; j < Index(elastic_.stages[i].row_count); ++j) {
      const double slack = elastic_solver_.solution().stages[i].slack[j];
      if (is_relaxed(i, j) && slack > largest.amount) {
        largest = {.constraint = rows_.constraint(i, j), .amount = slack};
      }
    }
  }
  if (!(largest.amount > settings_.qp.tolerance)) return std::nullopt;
  return largest;
}

void LpvMpc::ReadPlan(const TrackingInput& input) {
  for (std::size_t i = 0; i < plan_.z.size(); ++i) {
    plan_.z[i] = input.reference[i] + solver_.solution().stages[i].x.head<kStates>();
    if (i < plan_.u.size()) plan_.u[i] = solver_.solution().stages[i].u;
  }
  const bool bounded =
      settings_.trust_region && prediction_.exists() && plan_.status == SolverStatus::kSolved;
  const std::size_t last = plan_.u.size() - 1;
  (void)trust_region_.Measure(prediction_, last, last, bounded, plan_);
}

// ẑ_{i|k+1} = z*_{i+1|k}, û likewise (paper, eq:sch_pred). Without a plan the last prediction is shifted.
void LpvMpc::PredictNext() {
  if (plan_.status == SolverStatus::kSolved) prediction_.Set(plan_);
  prediction_.Shift();
}

}  // namespace control
