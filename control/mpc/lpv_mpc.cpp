#include "control/mpc/lpv_mpc.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "control/road/halfspace.hpp"

namespace control {
namespace {

constexpr int kPreviousInput = kStates;  // index of u_{k−1} in the QP's state
// The scheduled quantities in the order of p and of the trust radii: three states, then δ.
constexpr std::array kScheduledStates{kUpsilon, kNu, kPsi};
constexpr std::size_t kScheduledDelta = kScheduledStates.size();

std::size_t Index(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

LpvMpc::LpvMpc(const VehicleParameters& vehicle, const LpvMpcSettings& settings)
    : settings_(settings),
      model_(vehicle),
      qp_(settings.horizon),
      constraints_(Index(settings.horizon) + 1),
      solver_(settings.horizon, settings.qp),
      elastic_(settings.horizon),
      elastic_solver_(settings.horizon, settings.qp),
      guess_(settings.horizon),
      predicted_z_(Index(settings.horizon) + 1, State::Zero()),
      predicted_u_(Index(settings.horizon), Input::Zero()) {
  plan_.z.assign(Index(settings.horizon) + 1, State::Zero());
  plan_.u.assign(Index(settings.horizon), Input::Zero());
}

void LpvMpc::Reset() {
  has_prediction_ = false;
  has_guess_ = false;
}

bool LpvMpc::SetQpObserver(const QpObserver& observer) {
  show_qp_ = observer;
  return true;
}

const Plan& LpvMpc::Step(const TrackingInput& input) {
  assert(input.reference.size() == plan_.z.size());
  const bool scheduled_by_plan = has_prediction_;
  plan_.scheduling_error = 0.0;
  if (scheduled_by_plan) {
    const auto error = [&](double realised, double predicted, std::size_t j) {
      const double e = std::abs(realised - predicted) / settings_.trust_radius[static_cast<Eigen::Index>(j)];
      plan_.scheduling_error = std::max(plan_.scheduling_error, e);
    };
    for (std::size_t j = 0; j < kScheduledStates.size(); ++j) {
      error(input.z[kScheduledStates[j]], predicted_z_[0][kScheduledStates[j]], j);
    }
  } else {
    // Paper, alg:LPVMPC, line 1: p̂_{i|0} = (υ₀, ν₀, δ₀, ψ₀).
    std::ranges::fill(predicted_z_, input.z);
    std::ranges::fill(predicted_u_, input.u_previous);
  }
  BuildQp(input);
  if (show_qp_) show_qp_(qp_);
  const QpResult result = solver_.Solve(qp_, has_guess_ ? &guess_ : nullptr);
  plan_.status = result.status;
  plan_.iterations = result.iterations;
  ReadPlan(input);
  has_guess_ = result.MakesGuess();
  if (has_guess_) {
    guess_ = solver_.solution();
    guess_.Shift();
  }
  PredictNext();
  return plan_;
}

void LpvMpc::BuildQp(const TrackingInput& input) {
  const int N = settings_.horizon;
  qp_.x0 << input.z - input.reference[0], input.u_previous;
  for (int i = 0; i <= N; ++i) {
    auto& stage = qp_.stages[Index(i)];
    stage.Q.head<kStates>() = 2.0 * (i < N ? settings_.Q : settings_.P);
    stage.ClearRows();
    BuildRows(input, i);
    if (i == N) break;
    const State& z_hat = predicted_z_[Index(i)];
    const Scheduling p_hat{.upsilon = z_hat[kUpsilon],
                           .nu = z_hat[kNu],
                           .delta = predicted_u_[Index(i)][kDelta],
                           .psi = z_hat[kPsi]};
    const LinearModel model = model_.Discrete(p_hat, settings_.t_s, settings_.discretisation);
    stage.A.topLeftCorner<kStates, kStates>() = model.A;
    stage.B.topRows<kStates>() = model.B;
    stage.B.bottomRows<kInputs>().setIdentity();
    stage.c.head<kStates>() = model.A * input.reference[Index(i)] - input.reference[Index(i) + 1];
    stage.R = 2.0 * settings_.R;
  }
}

// The order is the same in every stage before N, so that multipliers can be handed on from one to the next: inputs,
// states, road, trust region of the states, obstacles. (Stage 0 has the first of them alone.)
void LpvMpc::BuildRows(const TrackingInput& input, int i) {
  auto& stage = qp_.stages[Index(i)];
  const State& z_ref = input.reference[Index(i)];
  using VectorX = Eigen::Matrix<double, 8, 1>;
  bool fits = true;
  // What the row added last stands for.
  const auto name = [&](ConstraintKind kind, int index) {
    constraints_[Index(i)][Index(stage.row_count - 1)] = {.kind = kind, .index = index, .step = i};
  };
  if (i < settings_.horizon) {
    for (int j = 0; j < kInputs; ++j) {
      fits &= stage.AddInputBound(j, settings_.u_min[j], settings_.u_max[j]);
      name(ConstraintKind::kInput, j);
      const VectorX C = -VectorX::Unit(kPreviousInput + j);
      fits &= stage.AddRow(C, Input::Unit(j), -settings_.rate_max[j], settings_.rate_max[j]);
      name(ConstraintKind::kRate, j);
    }
    if (settings_.trust_region && has_prediction_) {
      const double delta_hat = predicted_u_[Index(i)][kDelta];
      const double e = settings_.trust_radius[kScheduledDelta];
      fits &= stage.AddInputBound(kDelta, delta_hat - e, delta_hat + e, 2.0 * settings_.E_p[kScheduledDelta]);
    }
  }
  if (i == 0) return;  // the measured state cannot be changed
  for (int j = 0; j < kStates; ++j) {
    const double origin = j == kPsi ? 0.0 : z_ref[j];
    fits &= stage.AddStateBound(j, settings_.z_min[j] - origin, settings_.z_max[j] - origin);
    name(ConstraintKind::kState, j);
  }
  VectorX normal = VectorX::Zero();
  normal[kX] = -std::sin(z_ref[kPsi]);
  normal[kY] = std::cos(z_ref[kPsi]);
  fits &= stage.AddRow(normal, Input::Zero(), input.road.right, input.road.left);
  name(ConstraintKind::kRoad, 0);
  if (settings_.trust_region && has_prediction_ && i < settings_.horizon) {
    for (std::size_t j = 0; j < kScheduledStates.size(); ++j) {
      const int state = kScheduledStates[j];
      const double z_hat = predicted_z_[Index(i)][state] - z_ref[state];
      const double e = settings_.trust_radius[static_cast<Eigen::Index>(j)];
      fits &=
          stage.AddStateBound(state, z_hat - e, z_hat + e, 2.0 * settings_.E_p[static_cast<Eigen::Index>(j)]);
    }
  }
  for (const Obstacle& obstacle : input.obstacles) {
    const auto halfspace = ObstacleHalfSpace(obstacle, z_ref, settings_.obstacle_margin);
    if (!halfspace) continue;
    VectorX C = VectorX::Zero();
    C[kX] = halfspace->a;
    C[kY] = halfspace->b;
    const double lo = halfspace->c - halfspace->a * z_ref[kX] - halfspace->b * z_ref[kY];
    fits &= stage.AddRow(C, Input::Zero(), lo, kNoBound);
    name(ConstraintKind::kObstacle, obstacle.id);
  }
  // An obstacle that no longer fits must not be ignored: a row that cannot hold makes the problem infeasible.
  if (!fits) stage.rows.back() = {.C = VectorX::Zero(), .D = Input::Zero(), .lo = 1.0, .hi = kNoBound};
}

std::optional<ConstraintViolation> LpvMpc::DiagnoseInfeasibility() const {
  constexpr double kPenalty = 1e6;  // against costs of about 1 to 100: all but the least violation
  const auto holds_state = [](const Constraint& constraint) {
    return constraint.kind == ConstraintKind::kState || constraint.kind == ConstraintKind::kRoad ||
           constraint.kind == ConstraintKind::kObstacle;
  };
  // Trust-region rows are soft already, and have no name of their own.
  const auto gives_way = [&](std::size_t i, std::size_t j) {
    return !qp_.stages[i].rows[j].soft() && holds_state(constraints_[i][j]);
  };
  elastic_ = qp_;
  for (std::size_t i = 0; i < elastic_.stages.size(); ++i) {
    auto& stage = elastic_.stages[i];
    for (std::size_t j = 0; j < Index(stage.row_count); ++j) {
      if (gives_way(i, j)) stage.rows[j].rho = kPenalty;
    }
  }
  if (elastic_solver_.Solve(elastic_).status != SolverStatus::kSolved) return std::nullopt;
  ConstraintViolation largest;
  for (std::size_t i = 0; i < elastic_.stages.size(); ++i) {
    for (std::size_t j = 0; j < Index(elastic_.stages[i].row_count); ++j) {
      const double slack = elastic_solver_.solution().stages[i].slack[j];
      if (gives_way(i, j) && slack > largest.amount) {
        largest = {.constraint = constraints_[i][j], .amount = slack};
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
  MeasureTrustRegion();
}

void LpvMpc::MeasureTrustRegion() {
  plan_.active_trust_rows = 0;
  plan_.largest_slack = 0.0;
  if (!settings_.trust_region || !has_prediction_ || plan_.status != SolverStatus::kSolved) return;
  const auto measure = [&](double value, double predicted, std::size_t j) {
    const double deviation =
        std::abs(value - predicted) / settings_.trust_radius[static_cast<Eigen::Index>(j)];
    if (deviation >= 1.0 - 1e-6) ++plan_.active_trust_rows;
    plan_.largest_slack = std::max(plan_.largest_slack, deviation - 1.0);
  };
  for (std::size_t i = 0; i < plan_.u.size(); ++i) {
    measure(plan_.u[i][kDelta], predicted_u_[i][kDelta], kScheduledDelta);
    for (std::size_t j = 0; i > 0 && j < kScheduledStates.size(); ++j) {
      measure(plan_.z[i][kScheduledStates[j]], predicted_z_[i][kScheduledStates[j]], j);
    }
  }
}

// ẑ_{i|k+1} = z*_{i+1|k}, û likewise (paper, eq:sch_pred). Without a plan the last prediction moves on by one
// step.
void LpvMpc::PredictNext() {
  if (plan_.status == SolverStatus::kSolved) {
    std::ranges::copy(plan_.z, predicted_z_.begin());
    std::ranges::copy(plan_.u, predicted_u_.begin());
    has_prediction_ = true;
  }
  std::shift_left(predicted_z_.begin(), predicted_z_.end(), 1);
  std::shift_left(predicted_u_.begin(), predicted_u_.end(), 1);
}

}  // namespace control
