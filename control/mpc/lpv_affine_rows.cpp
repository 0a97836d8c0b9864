// The rows of LpvAffineMpc's QP, linearised about (ẑ, û) and written in deviations from the reference.
#include <algorithm>
#include <numbers>

#include "control/mpc/lpv_affine_mpc.hpp"
#include "control/vehicle/geometry.hpp"

namespace control {

void LpvAffineMpc::AddInputRows(const Input& u_previous, int i) {
  const State& z_ref = tracking_.reference()[Index(i)];
  const double across = z_ref[kUpsilon] * z_ref[kOmega] - disturbance_.a_y;
  const Input u_min = LeastInput(settings_, grip_), u_max = MostInput(settings_, vehicle_, grip_, across);
  for (int j = 0; j < kInputs; ++j) {
    const double step = settings_.rate_max[j];
    if (i < settings_.horizon) {
      rows_.AddInputBound({.kind = ConstraintKind::kRate, .index = j, .step = i}, j, -step, step);
    }
    if (i == 0) continue;
    // An input that is out of range returns as fast as its rate allows.
    const double lo = std::min(u_min[j], u_previous[j] + i * step);
    const double hi = std::max(u_max[j], u_previous[j] - i * step);
    const double u_ref = tracking_.reference_input()[Index(i - 1)][j];
    rows_.AddStateBound({.kind = ConstraintKind::kInput, .index = j, .step = i}, kPreviousInput + j,
                        lo - u_ref, hi - u_ref);
  }
}

// The lateral acceleration is linearised: υω ≈ υ̂ω + ω̂(υ − υ̂).
void LpvAffineMpc::AddFrictionRows(int i) {
  const State& z_ref = tracking_.reference()[Index(i)];
  const State& z_hat = prediction_.z()[Index(i)];
  const Softness softness{.rho = settings_.state_penalty, .sigma = settings_.state_penalty};
  rows_.AddStateBound({.kind = ConstraintKind::kState, .index = kUpsilon, .step = i}, kUpsilon,
                      -z_ref[kUpsilon], tracking_.SpeedLimit(Index(i)) - z_ref[kUpsilon], softness);
  QpState C = QpState::Zero();
  C[kOmega] = z_hat[kUpsilon];
  C[kUpsilon] = z_hat[kOmega];
  const double across = z_hat[kUpsilon] * z_ref[kOmega] +
                        z_hat[kOmega] * (z_ref[kUpsilon] - z_hat[kUpsilon]) - disturbance_.a_y;
  const double along = tracking_.reference_input()[Index(i - 1)][kAcceleration];
  for (const int sign : {0, 1, -1}) {
    const double limit = (sign == 0 ? 1.0 : std::numbers::sqrt2) * grip_;
    C[kPreviousInput + kAcceleration] = sign;
    const double at_ref = across + sign * along;
    rows_.AddRow({.kind = ConstraintKind::kFriction, .index = sign == 0 ? 0 : 1, .step = i}, C, Input::Zero(),
                 -limit - at_ref, limit - at_ref, softness);
  }
}

// The position of a point of the body is linearised in ψ.
void LpvAffineMpc::AddBodyRows(int i) {
  const State& z_hat = prediction_.z()[Index(i)];
  const State& z_ref = tracking_.reference()[Index(i)];
  const Eigen::Matrix2d to_map = Eigen::Rotation2Dd(z_hat[kPsi]).toRotationMatrix();
  for (const BodyRow& row : tracking_.rows(Index(i))) {
    const Eigen::Vector2d arm = to_map * row.fixed;
    QpState C = QpState::Zero();
    C[kX] = row.normal.x();
    C[kY] = row.normal.y();
    C[kPsi] = row.normal.dot(Eigen::Vector2d(-arm.y(), arm.x()));
    const double at_ref = row.normal.dot(Position(z_ref) + arm) + C[kPsi] * (z_ref[kPsi] - z_hat[kPsi]);
    const bool road = row.constraint.kind == ConstraintKind::kRoad;
    const double weight = road ? settings_.road_penalty : settings_.obstacle_penalty;
    rows_.AddRow(row.constraint, C, Input::Zero(), row.lo - at_ref, row.hi - at_ref,
                 {.rho = weight, .sigma = weight});
  }
}

void LpvAffineMpc::AddTrustRegion(int i) {
  const auto add = [&](int x, double predicted, std::size_t j) {
    const double e = trust_region_.Radius(j);
    rows_.AddStateBound({.kind = ConstraintKind::kTrust, .index = x, .step = i}, x, predicted - e,
                        predicted + e, {.rho = 2.0 * settings_.trust_weight / (e * e)});
  };
  for (std::size_t j = 0; j < kScheduledStates.size(); ++j) {
    const int x = kScheduledStates[j];
    add(x, prediction_.z()[Index(i)][x] - tracking_.reference()[Index(i)][x], j);
  }
  add(kPreviousInput + kDelta,
      prediction_.u()[Index(i - 1)][kDelta] - tracking_.reference_input()[Index(i - 1)][kDelta],
      kScheduledDelta);
}

}  // namespace control
