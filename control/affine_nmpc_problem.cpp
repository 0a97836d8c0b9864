#include "control/affine_nmpc_problem.hpp"

#include <algorithm>
#include <cstdlib>
#include <numbers>

#include "control/ocp_qp.hpp"
#include "control/plane.hpp"

namespace control {
namespace {

using Eigen::Vector2d;

// Soft rows of a step that are not of the body: of the speed, then of the friction.
constexpr int kSpeedRow = 0;
constexpr std::array kFrictionSigns{0, 1, -1};  // of a in the friction's rows
constexpr int kBodyRow = 1 + static_cast<int>(kFrictionSigns.size());

// The states that move the vehicle in its own frame, and of these those by which F is curved but for ψ.
constexpr std::array kCurved{kUpsilon, kNu, kPsi, kOmega};
constexpr std::array kDynamic{kUpsilon, kNu, kOmega};

// Where ∂F/∂z differs from zero: the place moves nothing but itself, and the heading nothing but it and the place.
constexpr bool Couples(int row, int column) {
  if (column <= kY) return row == column;
  return column != kPsi || row <= kY || row == kPsi;
}

std::size_t Index(int i) {
  return static_cast<std::size_t>(i);
}

template <typename Vector>
Eigen::Map<const Vector> At(std::span<const double> x, int i) {
  return Eigen::Map<const Vector>(x.subspan(Index(i), Vector::SizeAtCompileTime).data());
}

}  // namespace

AffineNmpcProblem::AffineNmpcProblem(const VehicleParameters& vehicle, const LpvAffineSettings& settings)
    : settings_(settings), model_(BlendedModel(vehicle), settings.t_s), steps_(Index(settings.horizon)) {}

void AffineNmpcProblem::Set(const DrivingTask& task, const Input& u_previous) {
  z_0_ = task.z();
  u_previous_ = u_previous;
  z_ref_.assign(task.reference().begin(), task.reference().end());
  u_ref_.assign(task.reference_input().begin(), task.reference_input().end());
  variables_ = rows_ = 0;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const auto body = task.rows(i + 1);
    steps_[i].first_variable = variables_;
    steps_[i].first_row = rows_;
    steps_[i].body.assign(body.begin(), body.end());
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
  constexpr double kBack = 0.99;  // of the rate
  for (int i = 0; i < horizon(); ++i) {
    for (int j = 0; j < kInputs; ++j) {
      const double step = settings_.rate_max[j];
      // An input that is out of range comes back almost as fast as it may: an interior point needs an interior.
      const double back = kBack * (i + 1) * step;
      bound(variable_bounds_, InputAt(i) + j, std::min(settings_.u_min[j], u_previous_[j] + back),
            std::max(settings_.u_max[j], u_previous_[j] - back));
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
  if (soft == kSpeedRow) return {0.0, settings_.upsilon_max};
  if (soft >= kBodyRow) return {Body(i, soft).lo, Body(i, soft).hi};
  const bool across = kFrictionSigns.at(Index(soft - 1)) == 0;
  const double limit = (across ? 1.0 : std::numbers::sqrt2) * Grip(settings_);
  return {-limit, limit};
}

AffineNmpcProblem::Row AffineNmpcProblem::SoftRow(int i, int soft, const State& z, const Input& u) const {
  Row row;
  if (soft == kSpeedRow) {
    row.value = z[kUpsilon];
    row.by_z[kUpsilon] = 1.0;
  } else if (soft < kBodyRow) {
    row.by_a = kFrictionSigns.at(Index(soft - 1));
    row.value = z[kUpsilon] * z[kOmega] + row.by_a * u[kAcceleration];
    row.by_z[kUpsilon] = z[kOmega];
    row.by_z[kOmega] = z[kUpsilon];
  } else {
    const BodyRow& body = Body(i, soft);
    const Vector2d arm = Turned(z[kPsi], body.fixed);
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

template <typename Visit>
void AffineNmpcProblem::VisitJacobian(std::span<const double> x, const Visit& visit) const {
  for (int i = 0; i < horizon(); ++i) {
    const Input input = InputOf(x, i);
    const State next = StateOf(x, i + 1);
    const LinearModel F = model_.Expand(StateOf(x, i), input).linear;
    const int row = RowAt(i), u = InputAt(i), z_next = StateAt(i + 1);
    for (int j = 0; j < kStates; ++j) {
      visit(row + j, z_next + j, 1.0);
      for (int c = 0; c < kInputs; ++c) visit(row + j, u + c, -F.B(j, c));
      for (int c = 0; i > 0 && c < kStates; ++c) {
        if (Couples(j, c)) visit(row + j, StateAt(i) + c, -F.A(j, c));
      }
    }
    for (int j = 0; j < kInputs; ++j) {
      visit(row + kStates + j, u + j, 1.0);
      if (i > 0) visit(row + kStates + j, InputAt(i - 1) + j, -1.0);
    }
    for (int soft = 0; soft < SoftRows(i + 1); ++soft) {
      const Row g = SoftRow(i + 1, soft, next, input);
      const int at = SoftRowAt(i + 1, soft);
      const auto by_state = [&](int j) { visit(at, z_next + j, g.by_z[j]); };
      if (soft >= kBodyRow) {
        by_state(kX);
        by_state(kY);
        by_state(kPsi);
      } else {
        by_state(kUpsilon);
        if (soft != kSpeedRow) by_state(kOmega);
        if (g.by_a != 0.0) visit(at, u + kAcceleration, g.by_a);
      }
      visit(at, SlackAt(i + 1, soft), 1.0);
      visit(at, SlackAt(i + 1, soft) + 1, -1.0);
    }
  }
}

// Of λᵀ F. The place adds nothing. A turn by ψ turns the motion in the map and nothing else, so its derivatives are those
// of first order, turned. What is left comes of one-sided differences.
AffineNmpcProblem::Curvature AffineNmpcProblem::ModelCurvature(const State& z, const Input& u,
                                                               const State& lambda) const {
  constexpr double kH = 1e-6;
  using Vector = Eigen::Matrix<double, kStates + kInputs, 1>;
  const auto gradient = [&lambda](const LinearModel& F) {
    Vector g;
    g << F.A.transpose() * lambda, F.B.transpose() * lambda;
    return g;
  };
  const LinearModel F = model_.Expand(z, u).linear;
  const Vector at = gradient(F);
  Curvature curvature = Curvature::Zero();
  for (const int j : kDynamic) {
    State moved = z;
    moved[j] += kH;
    curvature.col(j) = (gradient(model_.Expand(moved, u).linear) - at) / kH;
  }
  for (int j = 0; j < kInputs; ++j) {
    Input moved = u;
    moved[j] += kH;
    curvature.col(kStates + j) = (gradient(model_.Expand(z, moved).linear) - at) / kH;
  }
  const Vector2d turned(lambda[kY], -lambda[kX]);
  Vector by_psi = Vector::Zero();
  for (const int j : kCurved) by_psi[j] = turned.dot(F.A.col(j).head<2>());
  by_psi.tail<kInputs>() = F.B.topRows<2>().transpose() * turned;
  curvature.row(kPsi) = by_psi.transpose();
  curvature.col(kPsi) = by_psi;
  return 0.5 * (curvature + curvature.transpose());
}

template <typename Visit>
void AffineNmpcProblem::VisitHessian(std::span<const double> x, double sigma, std::span<const double> lambda,
                                     const Visit& visit) const {
  // Of z_i: cost, soft rows, and the model of the step that starts there.
  const auto visit_state = [&](int i, const Curvature& model) {
    const int z = StateAt(i);
    const State state = StateOf(x, i);
    double by_friction = 0.0, by_body = 0.0;
    for (int soft = kSpeedRow + 1; soft < SoftRows(i); ++soft) {
      const double multiplier = lambda[Index(SoftRowAt(i, soft))];
      if (soft < kBodyRow) {
        by_friction += multiplier;
      } else {
        const BodyRow& body = Body(i, soft);
        by_body -= multiplier * body.normal.dot(Turned(state[kPsi], body.fixed));
      }
    }
    for (const int j : {kX, kY}) visit(z + j, z + j, 2.0 * sigma * Weights(i)[j]);
    for (const int r : kCurved) {
      for (const int c : kCurved) {
        if (c > r) continue;
        double value = model(r, c);
        if (r == c) value += 2.0 * sigma * Weights(i)[r];
        if (r == kPsi && c == kPsi) value += by_body;
        if (r == kOmega && c == kUpsilon) value += by_friction;
        visit(z + r, z + c, value);
      }
    }
    for (int soft = 0; soft < SoftRows(i); ++soft) {
      for (const int side : {0, 1}) {
        const int slack = SlackAt(i, soft) + side;
        visit(slack, slack, sigma * Penalty(i, soft));
      }
    }
  };
  for (int i = 0; i < horizon(); ++i) {
    const Curvature model = -ModelCurvature(StateOf(x, i), InputOf(x, i), At<State>(lambda, RowAt(i)));
    if (i > 0) visit_state(i, model);
    const int u = InputAt(i);
    const double changes = i + 1 < horizon() ? 2.0 : 1.0;  // in which u_i takes part
    for (int j = 0; j < kInputs; ++j) {
      const double by_cost = 2.0 * sigma * (settings_.R[j] + changes * settings_.R_rate[j]);
      visit(u + j, u + j, by_cost + model(kStates + j, kStates + j));
      for (const int c : kCurved) {
        if (i > 0) visit(u + j, StateAt(i) + c, model(kStates + j, c));
      }
      if (i > 0) visit(u + j, InputAt(i - 1) + j, -2.0 * sigma * settings_.R_rate[j]);
    }
    visit(u + kAcceleration, u + kDelta, model(kStates + kAcceleration, kStates + kDelta));
  }
  visit_state(horizon(), Curvature::Zero());
}

void AffineNmpcProblem::MakePatterns() {
  const std::vector<double> x(Index(variables_), 1.0), lambda(Index(rows_), 0.0);
  jacobian_pattern_.clear();
  hessian_pattern_.clear();
  VisitJacobian(x, [this](int row, int column, double) { jacobian_pattern_.push_back({row, column}); });
  VisitHessian(x, 0.0, lambda, [this](int row, int column, double) {
    hessian_pattern_.push_back({row, column});
  });
}

void AffineNmpcProblem::Jacobian(std::span<const double> x, std::span<double> values) const {
  std::size_t k = 0;
  VisitJacobian(x, [&](int, int, double value) { values[k++] = value; });
}

void AffineNmpcProblem::Hessian(std::span<const double> x, double sigma, std::span<const double> lambda,
                                std::span<double> values) const {
  std::size_t k = 0;
  VisitHessian(x, sigma, lambda, [&](int, int, double value) { values[k++] = value; });
}

}  // namespace control
