#include "control/nmpc/affine_nmpc_problem.hpp"

#include <algorithm>
#include <cstdlib>
#include <numbers>

#include "control/qp/problem.hpp"
#include "control/vehicle/geometry.hpp"

namespace control {

namespace {

using Eigen::Vector2d;

}  // namespace

AffineNmpcProblem::AffineNmpcProblem(const VehicleParameters& vehicle, const LpvAffineSettings& settings)
    : vehicle_(vehicle), settings_(settings), model_(ModelWith({})), steps_(Index(settings.horizon)) {}

void AffineNmpcProblem::Set(const TrackingProblem& tracking, const Input& u_previous,
                            const Disturbance& disturbance, double mu_limit) {
  grip_ = Grip(settings_, mu_limit);
  model_ = ModelWith(disturbance);
  a_y_ = disturbance.a_y;
  z_0_ = tracking.z();
  u_previous_ = u_previous;
  z_ref_.assign(tracking.reference().begin(), tracking.reference().end());
  u_ref_.assign(tracking.reference_input().begin(), tracking.reference_input().end());
  variables_ = rows_ = 0;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const auto body = tracking.rows(i + 1);
    steps_[i].first_variable = variables_;
    steps_[i].first_row = rows_;
    steps_[i].body.assign(body.begin(), body.end());
    steps_[i].speed_limit = tracking.SpeedLimit(i + 1);
    const int soft = SoftRows(static_cast<int>(i) + 1);
    variables_ += kInputs + kStates + 2 * soft;
    rows_ += kStates + kInputs + soft;
  }
  SetBounds();
  MakePatterns();
}

void AffineNmpcProblem::SetBounds() {
  variable_bounds_.lo.assign(Index(variables_), -kNoBound);
  variable_bounds_.hi.assign(Index(variables_), kNoBound);
  row_bounds_.lo.assign(Index(rows_), 0.0);
  row_bounds_.hi.assign(Index(rows_), 0.0);
  const auto bound = [](Bounds& bounds, int at, double lo, double hi) {
    bounds.lo[Index(at)] = lo;
    bounds.hi[Index(at)] = hi;
  };
  constexpr double kBack = 0.99;  // share of the rate
  const Input u_min = LeastInput(settings_, grip_);
  for (int i = 0; i < horizon(); ++i) {
    const State& z_ref = z_ref_[Index(i) + 1];
    const Input u_max = MostInput(settings_, vehicle_, grip_, z_ref[kUpsilon] * z_ref[kOmega] - a_y_);
    for (int j = 0; j < kInputs; ++j) {
      const double step = settings_.rate_max[j];
      // An out-of-range input returns almost as fast as allowed: an interior-point method needs an interior.
      const double back = kBack * (i + 1) * step;
      bound(variable_bounds_, InputAt(i) + j, std::min(u_min[j], u_previous_[j] + back),
            std::max(u_max[j], u_previous_[j] - back));
      bound(row_bounds_, RowAt(i) + kStates + j, -step, step);
    }
    for (int soft = 0; soft < SoftRows(i + 1); ++soft) {
      const auto [lo, hi] = SoftBounds(i + 1, soft);
      bound(row_bounds_, SoftRowAt(i + 1, soft), lo, hi);
      const int slack = SlackAt(i + 1, soft);
      bound(variable_bounds_, slack, 0.0, lo > -kNoBound ? kNoBound : 0.0);
      bound(variable_bounds_, slack + 1, 0.0, hi < kNoBound ? kNoBound : 0.0);
    }
  }
}

int AffineNmpcProblem::SoftRows(int i) const {
  return kBodyRow + static_cast<int>(step(i - 1).body.size());
}

const BodyRow& AffineNmpcProblem::Body(int i, int soft) const {
  return step(i - 1).body[Index(soft - kBodyRow)];
}

Constraint AffineNmpcProblem::SoftConstraint(int i, int soft) const {
  if (soft == kSpeedRow) return {.kind = ConstraintKind::kState, .index = kUpsilon, .step = i};
  if (soft >= kBodyRow) return Body(i, soft).constraint;
  return {
      .kind = ConstraintKind::kFriction, .index = std::abs(kFrictionSigns.at(Index(soft - 1))), .step = i};
}

double AffineNmpcProblem::Penalty(int i, int soft) const {
  if (soft < kBodyRow) return settings_.state_penalty;
  const bool road = Body(i, soft).constraint.kind == ConstraintKind::kRoad;
  return road ? settings_.road_penalty : settings_.obstacle_penalty;
}

std::array<double, 2> AffineNmpcProblem::SoftBounds(int i, int soft) const {
  if (soft == kSpeedRow) return {0.0, steps_[Index(i - 1)].speed_limit};
  if (soft >= kBodyRow) return {Body(i, soft).lo, Body(i, soft).hi};
  const bool across = kFrictionSigns.at(Index(soft - 1)) == 0;
  const double limit = (across ? 1.0 : std::numbers::sqrt2) * grip_;
  return {-limit, limit};
}

AffineNmpcProblem::Row AffineNmpcProblem::SoftRow(int i, int soft, const State& z, const Input& u) const {
  Row row;
  if (soft == kSpeedRow) {
    row.value = z[kUpsilon];
    row.by_z[kUpsilon] = 1.0;
  } else if (soft < kBodyRow) {
    row.by_a = kFrictionSigns.at(Index(soft - 1));
    row.value = z[kUpsilon] * z[kOmega] - a_y_ + row.by_a * u[kAcceleration];
    row.by_z[kUpsilon] = z[kOmega];
    row.by_z[kOmega] = z[kUpsilon];
  } else {
    const BodyRow& body = Body(i, soft);
    const Vector2d arm = Rotate(z[kPsi], body.fixed);
    row.value = body.normal.dot(z.head<2>() + arm);
    row.by_z.head<2>() = body.normal;
    row.by_z[kPsi] = body.normal.dot(Vector2d(-arm.y(), arm.x()));
  }
  return row;
}

State AffineNmpcProblem::StateOf(std::span<const double> x, int i) const {
  return i == 0 ? z_0_ : State(At<State>(x, StateAt(i)));
}

Input AffineNmpcProblem::InputOf(std::span<const double> x, int i) const {
  return i < 0 ? u_previous_ : Input(At<Input>(x, InputAt(i)));
}

State AffineNmpcProblem::Weights(int i) const {
  return i < horizon() ? settings_.Q : State(settings_.terminal * settings_.Q);
}

double AffineNmpcProblem::Slack(std::span<const double> x, int i, int soft) const {
  const std::size_t at = Index(SlackAt(i, soft));
  return std::max(x[at], x[at + 1]);
}

std::vector<double> AffineNmpcProblem::PointOf(std::span<const State> z, std::span<const Input> u) const {
  std::vector<double> x(Index(variables_), 0.0);
  for (int i = 1; i <= horizon(); ++i) {
    std::ranges::copy(u[Index(i - 1)], x.begin() + InputAt(i - 1));
    std::ranges::copy(z[Index(i)], x.begin() + StateAt(i));
    for (int soft = 0; soft < SoftRows(i); ++soft) {
      const double value = SoftRow(i, soft, z[Index(i)], u[Index(i - 1)]).value;
      const auto [lo, hi] = SoftBounds(i, soft);
      x[Index(SlackAt(i, soft))] = std::max(lo - value, 0.0);
      x[Index(SlackAt(i, soft)) + 1] = std::max(value - hi, 0.0);
    }
  }
  return x;
}

double AffineNmpcProblem::Cost(std::span<const double> x) const {
  double cost = 0.0;
  for (int i = 0; i < horizon(); ++i) {
    const Input u = InputOf(x, i);
    cost += Weights(i + 1).dot((StateOf(x, i + 1) - z_ref_[Index(i) + 1]).cwiseAbs2());
    cost += settings_.R.dot((u - u_ref_[Index(i)]).cwiseAbs2());
    cost += settings_.R_rate.dot((u - InputOf(x, i - 1)).cwiseAbs2());
    for (int soft = 0; soft < SoftRows(i + 1); ++soft) {
      for (const int side : {0, 1}) {
        const double slack = x[Index(SlackAt(i + 1, soft) + side)];
        cost += Penalty(i + 1, soft) * (slack + 0.5 * slack * slack);
      }
    }
  }
  return cost;
}

void AffineNmpcProblem::Gradient(std::span<const double> x, std::span<double> gradient) const {
  std::ranges::fill(gradient, 0.0);
  for (int i = 0; i < horizon(); ++i) {
    const Input u = InputOf(x, i);
    const Input by_u = 2.0 * settings_.R.cwiseProduct(u - u_ref_[Index(i)]);
    const Input by_change = 2.0 * settings_.R_rate.cwiseProduct(u - InputOf(x, i - 1));
    const State by_z = 2.0 * Weights(i + 1).cwiseProduct(StateOf(x, i + 1) - z_ref_[Index(i) + 1]);
    for (int j = 0; j < kInputs; ++j) {
      gradient[Index(InputAt(i) + j)] += by_u[j] + by_change[j];
      if (i > 0) gradient[Index(InputAt(i - 1) + j)] -= by_change[j];
    }
    for (int j = 0; j < kStates; ++j) gradient[Index(StateAt(i + 1) + j)] = by_z[j];
    for (int soft = 0; soft < SoftRows(i + 1); ++soft) {
      for (const int side : {0, 1}) {
        const std::size_t at = Index(SlackAt(i + 1, soft) + side);
        gradient[at] = Penalty(i + 1, soft) * (1.0 + x[at]);
      }
    }
  }
}

void AffineNmpcProblem::Rows(std::span<const double> x, std::span<double> g) const {
  for (int i = 0; i < horizon(); ++i) {
    const State z_next = StateOf(x, i + 1);
    const Input u = InputOf(x, i);
    const State model = z_next - model_.Step(StateOf(x, i), u);
    const Input change = u - InputOf(x, i - 1);
    for (int j = 0; j < kStates; ++j) g[Index(RowAt(i) + j)] = model[j];
    for (int j = 0; j < kInputs; ++j) g[Index(RowAt(i) + kStates + j)] = change[j];
    for (int soft = 0; soft < SoftRows(i + 1); ++soft) {
      const std::size_t slack = Index(SlackAt(i + 1, soft));
      g[Index(SoftRowAt(i + 1, soft))] = SoftRow(i + 1, soft, z_next, u).value + x[slack] - x[slack + 1];
    }
  }
}

}  // namespace control
