// The rows of LpvAffineMpc's QP, each to first order about (ẑ, û) and in deviations from the reference.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "control/keep_out.hpp"
#include "control/lpv_affine_mpc.hpp"
#include "control/lpv_affine_terms.hpp"

namespace control {

using namespace lpv_affine;

namespace {

using Eigen::Vector2d;
using VectorX = Eigen::Matrix<double, kStates + kInputs, 1>;

Vector2d Along(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

Vector2d Left(double angle) {
  return {-std::sin(angle), std::cos(angle)};
}

Vector2d Turned(double psi, const Vector2d& v) {
  return v.x() * Along(psi) + v.y() * Left(psi);
}

Vector2d Position(const State& z) {
  return {z[kX], z[kY]};
}

// normalᵀ p as a function of the state, to first order about z_hat, p being the point `fixed` of the vehicle's body:
// C (z − z_ref) + at_ref.
struct PointOfBody {
  VectorX C = VectorX::Zero();
  double at_ref = 0.0;

  PointOfBody(const Vector2d& normal, const Vector2d& fixed, const State& z_hat, const State& z_ref) {
    const Vector2d arm = Turned(z_hat[kPsi], fixed);
    C[kX] = normal.x();
    C[kY] = normal.y();
    C[kPsi] = normal.dot(Vector2d(-arm.y(), arm.x()));
    at_ref = normal.dot(Position(z_ref) + arm) + C[kPsi] * (z_ref[kPsi] - z_hat[kPsi]);
  }
};

}  // namespace

void LpvAffineMpc::BuildRows(const Input& u_previous, std::span<const Obstacle> obstacles, int i) {
  AddInputRows(u_previous, i);
  if (i == 0) return;  // the measured state cannot be changed
  AddFrictionRows(i);
  AddRoadRows(i);
  if (settings_.trust_region && has_prediction_) AddTrustRegion(i);
  AddObstacleRows(obstacles, i);
}

void LpvAffineMpc::Name(int i, ConstraintKind kind, int index) {
  constraints_[Index(i)][Index(qp_.stages[Index(i)].row_count - 1)] = {
      .kind = kind, .index = index, .step = i};
}

void LpvAffineMpc::AddInputRows(const Input& u_previous, int i) {
  auto& stage = qp_.stages[Index(i)];
  for (int j = 0; j < kInputs; ++j) {
    const double step = settings_.rate_max[j];
    if (i < settings_.horizon) {
      fits_ &= stage.AddInputBound(j, -step, step);
      Name(i, ConstraintKind::kRate, j);
    }
    if (i == 0) continue;
    // An input that is out of range comes back as fast as it may.
    const double lo = std::min(settings_.u_min[j], u_previous[j] + i * step);
    const double hi = std::max(settings_.u_max[j], u_previous[j] - i * step);
    const double u_ref = u_ref_[Index(i - 1)][j];
    fits_ &= stage.AddStateBound(kU + j, lo - u_ref, hi - u_ref);
    Name(i, ConstraintKind::kInput, j);
  }
}

// υω ≈ υ̂ω + ω̂(υ − υ̂).
void LpvAffineMpc::AddFrictionRows(int i) {
  auto& stage = qp_.stages[Index(i)];
  const State& z_ref = z_ref_[Index(i)];
  const State& z_hat = z_hat_[Index(i)];
  const double weight = settings_.state_penalty;
  fits_ &= stage.AddStateBound(kUpsilon, -z_ref[kUpsilon], settings_.upsilon_max - z_ref[kUpsilon], weight,
                               weight);
  Name(i, ConstraintKind::kState, kUpsilon);
  VectorX C = VectorX::Zero();
  C[kOmega] = z_hat[kUpsilon];
  C[kUpsilon] = z_hat[kOmega];
  const double across = z_hat[kUpsilon] * z_ref[kOmega] + z_hat[kOmega] * (z_ref[kUpsilon] - z_hat[kUpsilon]);
  const double along = u_ref_[Index(i - 1)][kAcceleration];
  for (const int sign : {0, 1, -1}) {
    const double limit = (sign == 0 ? 1.0 : std::numbers::sqrt2) * Grip(settings_);
    C[kU + kAcceleration] = sign;
    const double at_ref = across + sign * along;
    fits_ &= stage.AddRow(C, Input::Zero(), -limit - at_ref, limit - at_ref, weight, weight);
    Name(i, ConstraintKind::kFriction, sign);
  }
}

// For the middles of the front and the rear end; the corners are half a width beside them.
void LpvAffineMpc::AddRoadRows(int i) {
  const State& z_hat = z_hat_[Index(i)];
  const RoutePoint& beside = beside_[Index(i)];
  const Vector2d left = Left(beside.psi), course(beside.X, beside.Y);
  const double inside = settings_.footprint.half_width + settings_.road_margin;
  for (const double end : {settings_.footprint.front, -settings_.footprint.rear}) {
    const Vector2d fixed(end, 0.0);
    const PointOfBody lateral(left, fixed, z_hat, z_ref_[Index(i)]);
    // The course bends away from its tangent.
    const double ahead = Along(beside.psi).dot(Position(z_hat) + Turned(z_hat[kPsi], fixed) - course);
    const double origin = lateral.at_ref - left.dot(course) - 0.5 * beside.curvature * ahead * ahead;
    fits_ &= qp_.stages[Index(i)].AddRow(lateral.C, Input::Zero(), course_->road().right + inside - origin,
                                         course_->road().left - inside - origin, settings_.road_penalty,
                                         settings_.road_penalty);
    Name(i, ConstraintKind::kRoad, end > 0.0 ? 0 : 1);
  }
}

void LpvAffineMpc::AddTrustRegion(int i) {
  auto& stage = qp_.stages[Index(i)];
  const auto add = [&](int x, double predicted, std::size_t j) {
    const double e = trust_scale_ * settings_.trust_radius[static_cast<Eigen::Index>(j)];
    fits_ &= stage.AddStateBound(x, predicted - e, predicted + e, 2.0 * settings_.trust_weight / (e * e));
    Name(i, ConstraintKind::kTrust, x);
  };
  for (std::size_t j = 0; j < kScheduledStates.size(); ++j) {
    const int x = kScheduledStates[j];
    add(x, z_hat_[Index(i)][x] - z_ref_[Index(i)][x], j);
  }
  add(kU + kDelta, u_hat_[Index(i - 1)][kDelta] - u_ref_[Index(i - 1)][kDelta], kScheduledDelta);
}

std::optional<HalfSpace> LpvAffineMpc::Outside(const Obstacle& obstacle, Passage passage, int i) const {
  const State& z_hat = z_hat_[Index(i)];
  const double psi_road = beside_[Index(i)].psi;
  if (passage == Passage::kStop) return HalfSpaceBefore(obstacle, psi_road, settings_.obstacle_margin);
  const PassingSide side = passage == Passage::kLeft ? PassingSide::kLeft : PassingSide::kRight;
  const double reach = 0.5 * settings_.t_s * z_hat[kUpsilon] + settings_.obstacle_margin;
  return PassingHalfSpace(obstacle, side, z_hat, psi_road, settings_.footprint, settings_.obstacle_margin,
                          reach);
}

void LpvAffineMpc::AddObstacleRows(std::span<const Obstacle> obstacles, int i) {
  const State& z_hat = z_hat_[Index(i)];
  for (std::size_t k = 0; k < decisions_.size(); ++k) {
    const Passage passage = decisions_[k].passage;
    if (passage == Passage::kIgnored || (passage == Passage::kStop && k != first_stop_)) continue;
    const auto outside = Outside(Moved(obstacles[k], i * settings_.t_s), passage, i);
    if (!outside) continue;
    const Vector2d normal(outside->a, outside->b);
    std::array<Vector2d, 4> corners = settings_.footprint.Corners();
    std::ranges::sort(corners, {},
                      [&](const Vector2d& corner) { return normal.dot(Turned(z_hat[kPsi], corner)); });
    for (const std::size_t nearest : {0U, 1U}) {
      const PointOfBody point(normal, corners[nearest], z_hat, z_ref_[Index(i)]);
      fits_ &= qp_.stages[Index(i)].AddRow(point.C, Input::Zero(), outside->c - point.at_ref, kNoBound,
                                           settings_.obstacle_penalty, settings_.obstacle_penalty);
      Name(i, ConstraintKind::kObstacle, obstacles[k].id);
    }
  }
}

}  // namespace control
