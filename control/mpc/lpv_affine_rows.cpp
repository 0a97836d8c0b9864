// The rows of LpvAffineMpc's QP, each to first order about (ẑ, û) and in deviations from the reference.
#include <algorithm>
#include <cstdlib>
#include <numbers>

#include "control/mpc/lpv_affine_mpc.hpp"
#include "control/mpc/lpv_affine_terms.hpp"
#include "control/vehicle/geometry.hpp"

namespace control {

using namespace lpv_affine;

namespace {

using Eigen::Vector2d;
using VectorX = Eigen::Matrix<double, kStates + kInputs, 1>;

}  // namespace

void LpvAffineMpc::Name(int i, ConstraintKind kind, int index) {
  constraints_[Index(i)][Index(qp_.stages[Index(i)].row_count - 1)] = {
      .kind = kind, .index = index, .step = i};
}

bool LpvAffineMpc::AddInputRows(const Input& u_previous, int i) {
  auto& stage = qp_.stages[Index(i)];
  bool fits = true;
  for (int j = 0; j < kInputs; ++j) {
    const double step = settings_.rate_max[j];
    if (i < settings_.horizon) {
      fits &= stage.AddInputBound(j, -step, step);
      Name(i, ConstraintKind::kRate, j);
    }
    if (i == 0) continue;
    // An input that is out of range comes back as fast as it may.
    const double lo = std::min(settings_.u_min[j], u_previous[j] + i * step);
    const double hi = std::max(settings_.u_max[j], u_previous[j] - i * step);
    const double u_ref = task_.reference_input()[Index(i - 1)][j];
    fits &= stage.AddStateBound(kU + j, lo - u_ref, hi - u_ref);
    Name(i, ConstraintKind::kInput, j);
  }
  return fits;
}

// υω ≈ υ̂ω + ω̂(υ − υ̂).
bool LpvAffineMpc::AddFrictionRows(int i) {
  auto& stage = qp_.stages[Index(i)];
  const State& z_ref = task_.reference()[Index(i)];
  const State& z_hat = prediction_.z()[Index(i)];
  const double weight = settings_.state_penalty;
  bool fits = stage.AddStateBound(kUpsilon, -z_ref[kUpsilon], settings_.upsilon_max - z_ref[kUpsilon], weight,
                                  weight);
  Name(i, ConstraintKind::kState, kUpsilon);
  VectorX C = VectorX::Zero();
  C[kOmega] = z_hat[kUpsilon];
  C[kUpsilon] = z_hat[kOmega];
  const double across = z_hat[kUpsilon] * z_ref[kOmega] + z_hat[kOmega] * (z_ref[kUpsilon] - z_hat[kUpsilon]);
  const double along = task_.reference_input()[Index(i - 1)][kAcceleration];
  for (const int sign : {0, 1, -1}) {
    const double limit = (sign == 0 ? 1.0 : std::numbers::sqrt2) * Grip(settings_);
    C[kU + kAcceleration] = sign;
    const double at_ref = across + sign * along;
    fits &= stage.AddRow(C, Input::Zero(), -limit - at_ref, limit - at_ref, weight, weight);
    Name(i, ConstraintKind::kFriction, std::abs(sign));
  }
  return fits;
}

// Where a point of the body is, to first order in ψ.
bool LpvAffineMpc::AddBodyRows(int i) {
  const State& z_hat = prediction_.z()[Index(i)];
  const State& z_ref = task_.reference()[Index(i)];
  bool fits = true;
  for (const BodyRow& row : task_.rows(Index(i))) {
    const Vector2d arm = Rotate(z_hat[kPsi], row.fixed);
    VectorX C = VectorX::Zero();
    C[kX] = row.normal.x();
    C[kY] = row.normal.y();
    C[kPsi] = row.normal.dot(Vector2d(-arm.y(), arm.x()));
    const double at_ref = row.normal.dot(Position(z_ref) + arm) + C[kPsi] * (z_ref[kPsi] - z_hat[kPsi]);
    const bool road = row.constraint.kind == ConstraintKind::kRoad;
    const double weight = road ? settings_.road_penalty : settings_.obstacle_penalty;
    fits &= qp_.stages[Index(i)].AddRow(C, Input::Zero(), row.lo - at_ref, row.hi - at_ref, weight, weight);
    Name(i, row.constraint.kind, row.constraint.index);
  }
  return fits;
}

bool LpvAffineMpc::AddTrustRegion(int i) {
  auto& stage = qp_.stages[Index(i)];
  bool fits = true;
  const auto add = [&](int x, double predicted, std::size_t j) {
    const double e = trust_scale_ * settings_.trust_radius[static_cast<Eigen::Index>(j)];
    fits &= stage.AddStateBound(x, predicted - e, predicted + e, 2.0 * settings_.trust_weight / (e * e));
    Name(i, ConstraintKind::kTrust, x);
  };
  for (std::size_t j = 0; j < kScheduledStates.size(); ++j) {
    const int x = kScheduledStates[j];
    add(x, prediction_.z()[Index(i)][x] - task_.reference()[Index(i)][x], j);
  }
  add(kU + kDelta, prediction_.u()[Index(i - 1)][kDelta] - task_.reference_input()[Index(i - 1)][kDelta],
      kScheduledDelta);
  return fits;
}

}  // namespace control
