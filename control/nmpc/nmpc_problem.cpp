#include "control/nmpc/nmpc_problem.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "control/vehicle/geometry.hpp"
#include "control/vehicle/obstacle_geometry.hpp"

namespace control {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

// Rows of a step after those of the model.
constexpr int kRateRow = kStates;
constexpr int kRoadRow = kRateRow + kInputs;
constexpr int kObstacleRow = kRoadRow + 1;

struct Place {
  int row;
  int column;
};
// The non-zero first derivatives of z + t_s f(z, u).
constexpr std::array kByState{Place{kX, kX},        Place{kX, kUpsilon},     Place{kX, kNu},
                              Place{kX, kPsi},      Place{kY, kY},           Place{kY, kNu},
                              Place{kY, kUpsilon},  Place{kY, kPsi},         Place{kUpsilon, kUpsilon},
                              Place{kUpsilon, kNu}, Place{kUpsilon, kOmega}, Place{kNu, kUpsilon},
                              Place{kNu, kNu},      Place{kNu, kOmega},      Place{kPsi, kPsi},
                              Place{kPsi, kOmega},  Place{kOmega, kUpsilon}, Place{kOmega, kNu},
                              Place{kOmega, kOmega}};
constexpr std::array kByInput{Place{kUpsilon, kAcceleration}, Place{kNu, kDelta}, Place{kOmega, kDelta}};
// Its non-zero mixed second derivatives: pairs of different states, and states paired with δ.
constexpr std::array kCurvedStates{Place{kNu, kUpsilon}, Place{kPsi, kUpsilon}, Place{kPsi, kNu},
                                   Place{kOmega, kUpsilon}, Place{kOmega, kNu}};
constexpr std::array kCurvedWithDelta{kUpsilon, kNu, kOmega};

}  // namespace

NmpcProblem::NmpcProblem(const VehicleParameters& vehicle, const MpcSettings& settings)
    : settings_(settings), model_(vehicle) {}

State NmpcProblem::StateOf(std::span<const double> x, int i) const {
  return i == 0 ? z_0_ : State(At<State>(x, StateAt(i)));
}

Input NmpcProblem::InputOf(std::span<const double> x, int i) const {
  return At<Input>(x, InputAt(i));
}

// The road's left normal at step i.
Eigen::Vector2d NmpcProblem::Normal(int i) const {
  return LeftOf(reference_[Index(i)][kPsi]);
}

void NmpcProblem::Set(const TrackingInput& input) {
  assert(input.reference.size() == Index(horizon()) + 1);
  z_0_ = input.z;
  reference_.assign(input.reference.begin(), input.reference.end());
  const bool resized = jacobian_pattern_.empty() || ellipses_.size() != input.obstacles.size();
  ellipses_.clear();
  for (const Obstacle& obstacle : input.obstacles) {
    const Obstacle ellipse = EnclosingEllipse(obstacle);
    const Eigen::Matrix2d axes = Eigen::Rotation2Dd(ellipse.heading).toRotationMatrix();
    const Eigen::Vector2d radii(ellipse.r_x + settings_.obstacle_margin,
                                ellipse.r_y + settings_.obstacle_margin);
    ellipses_.push_back({.centre = {ellipse.X, ellipse.Y},
                         .M = axes * radii.cwiseAbs2().cwiseInverse().asDiagonal() * axes.transpose(),
                         .smaller_semi_axis = radii.minCoeff(),
                         .id = ellipse.id});
  }
  if (resized) MakePatterns();

  variable_bounds_.lo.clear();
  variable_bounds_.hi.clear();
  row_bounds_.lo.clear();
  row_bounds_.hi.clear();
  const auto bound = [](Bounds& bounds, double lo, double hi) {
    bounds.lo.push_back(lo);
    bounds.hi.push_back(hi);
  };
  for (int i = 0; i < horizon(); ++i) {
    const State& z_ref = reference_[Index(i) + 1];
    for (int j = 0; j < kInputs; ++j) bound(variable_bounds_, settings_.u_min[j], settings_.u_max[j]);
    for (int j = 0; j < kStates; ++j) {
      const double origin = j == kPsi ? z_ref[kPsi] : 0.0;
      bound(variable_bounds_, settings_.z_min[j] + origin, settings_.z_max[j] + origin);
    }
    for (int j = 0; j < kStates; ++j) bound(row_bounds_, 0.0, 0.0);
    for (int j = 0; j < kInputs; ++j) {
      const double origin = i == 0 ? input.u_previous[j] : 0.0;
      bound(row_bounds_, origin - settings_.rate_max[j], origin + settings_.rate_max[j]);
    }
    const double middle = Normal(i + 1).dot(z_ref.head<2>());
    const RoadBounds& road = input.road[Index(i) + 1];
    bound(row_bounds_, middle + road.right, middle + road.left);
    for (std::size_t j = 0; j < ellipses_.size(); ++j) bound(row_bounds_, 1.0, kNone);
  }
}

double NmpcProblem::Cost(std::span<const double> x) const {
  double cost = 0.0;
  for (int i = 0; i < horizon(); ++i) {
    cost += settings_.R.dot(InputOf(x, i).cwiseAbs2());
    cost += Weights(i + 1).dot((StateOf(x, i + 1) - reference_[Index(i) + 1]).cwiseAbs2());
  }
  return cost;
}

void NmpcProblem::Gradient(std::span<const double> x, std::span<double> gradient) const {
  for (int i = 0; i < horizon(); ++i) {
    const Input by_u = 2.0 * settings_.R.cwiseProduct(InputOf(x, i));
    const State by_z = 2.0 * Weights(i + 1).cwiseProduct(StateOf(x, i + 1) - reference_[Index(i) + 1]);
    for (int j = 0; j < kInputs; ++j) gradient[Index(InputAt(i) + j)] = by_u[j];
    for (int j = 0; j < kStates; ++j) gradient[Index(StateAt(i + 1) + j)] = by_z[j];
  }
}

void NmpcProblem::Rows(std::span<const double> x, std::span<double> g) const {
  for (int i = 0; i < horizon(); ++i) {
    const State z = StateOf(x, i), z_next = StateOf(x, i + 1);
    const Input u = InputOf(x, i), u_last = i == 0 ? Input::Zero() : InputOf(x, i - 1);
    const State model = z_next - Next(z, u);
    const std::span<double> rows = g.subspan(Index(i * StepRows()), Index(StepRows()));
    for (int j = 0; j < kStates; ++j) rows[Index(j)] = model[j];
    for (int j = 0; j < kInputs; ++j) rows[Index(kRateRow + j)] = u[j] - u_last[j];
    rows[kRoadRow] = Normal(i + 1).dot(z_next.head<2>());
    for (std::size_t j = 0; j < ellipses_.size(); ++j) {
      const Eigen::Vector2d d = z_next.head<2>() - ellipses_[j].centre;
      rows[kObstacleRow + j] = d.dot(ellipses_[j].M * d);
    }
  }
}

template <typename Visit>
void NmpcProblem::VisitJacobian(std::span<const double> x, const Visit& visit) const {
  for (int i = 0; i < horizon(); ++i) {
    const int row = i * StepRows();
    const LinearModel f = model_.Jacobian(StateOf(x, i), InputOf(x, i));
    const int u = InputAt(i), z = StateAt(i), z_next = StateAt(i + 1);
    for (int j = 0; j < kStates; ++j) visit(row + j, z_next + j, 1.0);
    for (const auto& [r, c] : kByInput) visit(row + r, u + c, -settings_.t_s * f.B(r, c));
    for (const auto& [r, c] : kByState) {
      if (i > 0) visit(row + r, z + c, -(r == c ? 1.0 : 0.0) - settings_.t_s * f.A(r, c));
    }
    for (int j = 0; j < kInputs; ++j) {
      visit(row + kRateRow + j, u + j, 1.0);
      if (i > 0) visit(row + kRateRow + j, InputAt(i - 1) + j, -1.0);
    }
    const Eigen::Vector2d normal = Normal(i + 1);
    visit(row + kRoadRow, z_next + kX, normal.x());
    visit(row + kRoadRow, z_next + kY, normal.y());
    for (std::size_t j = 0; j < ellipses_.size(); ++j) {
      const Eigen::Vector2d d = StateOf(x, i + 1).head<2>() - ellipses_[j].centre;
      const Eigen::Vector2d gradient = 2.0 * ellipses_[j].M * d;
      visit(row + kObstacleRow + static_cast<int>(j), z_next + kX, gradient.x());
      visit(row + kObstacleRow + static_cast<int>(j), z_next + kY, gradient.y());
    }
  }
}

template <typename Visit>
void NmpcProblem::VisitHessian(std::span<const double> x, double sigma, std::span<const double> lambda,
                               const Visit& visit) const {
  using Curvature = SingleTrackModel::Curvature;
  // The entries of z_i: the cost, the obstacles and the model of the step that starts there.
  const auto visit_state = [&](int i, const Curvature& model) {
    const int z = StateAt(i);
    Eigen::Matrix2d obstacles = Eigen::Matrix2d::Zero();
    for (std::size_t j = 0; j < ellipses_.size(); ++j) {
      obstacles += 2.0 * lambda[Index((i - 1) * StepRows() + kObstacleRow) + j] * ellipses_[j].M;
    }
    for (int j = 0; j < kStates; ++j) {
      const double by_obstacles = j <= kY ? obstacles(j, j) : 0.0;
      visit(z + j, z + j, 2.0 * sigma * Weights(i)[j] + by_obstacles + model(j, j));
    }
    visit(z + kY, z + kX, obstacles(1, 0));
    for (const auto& [r, c] : kCurvedStates) visit(z + r, z + c, model(r, c));
  };
  for (int i = 0; i < horizon(); ++i) {
    const State pi = At<State>(lambda, i * StepRows());
    const Curvature model = -settings_.t_s * model_.Hessian(StateOf(x, i), InputOf(x, i), pi);
    if (i > 0) visit_state(i, model);
    const int u = InputAt(i);
    for (int j = 0; j < kInputs; ++j) {
      visit(u + j, u + j, 2.0 * sigma * settings_.R[j] + model(kStates + j, kStates + j));
    }
    for (const int j : kCurvedWithDelta) {
      if (i > 0) visit(u + kDelta, StateAt(i) + j, model(kStates + kDelta, j));
    }
  }
  visit_state(horizon(), Curvature::Zero());
}

void NmpcProblem::MakePatterns() {
  const std::vector<double> x(Index(variables()), 1.0), lambda(Index(rows()), 0.0);
  jacobian_pattern_.clear();
  hessian_pattern_.clear();
  VisitJacobian(x, [this](int row, int column, double) { jacobian_pattern_.push_back({row, column}); });
  VisitHessian(x, 0.0, lambda, [this](int row, int column, double) {
    hessian_pattern_.push_back({row, column});
  });
}

void NmpcProblem::Jacobian(std::span<const double> x, std::span<double> values) const {
  std::size_t k = 0;
  VisitJacobian(x, [&](int, int, double value) { values[k++] = value; });
}

void NmpcProblem::Hessian(std::span<const double> x, double sigma, std::span<const double> lambda,
                          std::span<double> values) const {
  std::size_t k = 0;
  VisitHessian(x, sigma, lambda, [&](int, int, double value) { values[k++] = value; });
}

State NmpcProblem::Next(const State& z, const Input& u) const {
  return z + settings_.t_s * model_.Derivative(z, u);
}

std::vector<double> NmpcProblem::Driven(std::span<const double> x) const {
  std::vector<double> driven(x.begin(), x.end());
  State z = z_0_;
  for (int i = 0; i < horizon(); ++i) {
    z = Next(z, InputOf(x, i));
    std::ranges::copy(z, driven.begin() + StateAt(i + 1));
  }
  return driven;
}

Constraint NmpcProblem::RowConstraint(int row) const {
  const int i = row / StepRows(), j = row % StepRows();
  if (j < kRateRow) return {.kind = ConstraintKind::kModel, .index = j, .step = i + 1};
  if (j < kRoadRow) return {.kind = ConstraintKind::kRate, .index = j - kRateRow, .step = i};
  if (j < kObstacleRow) return {.kind = ConstraintKind::kRoad, .index = 0, .step = i + 1};
  return {.kind = ConstraintKind::kObstacle, .index = ellipses_[Index(j - kObstacleRow)].id, .step = i + 1};
}

ConstraintViolation NmpcProblem::LargestViolation(std::span<const double> x) const {
  ConstraintViolation largest;
  const auto raise = [&largest](double value, double lo, double hi, const Constraint& constraint) {
    const double amount = std::max(lo - value, value - hi);
    if (amount > largest.amount) largest = {.constraint = constraint, .amount = amount};
  };
  std::vector<double> g(Index(rows()));
  Rows(x, g);
  for (int row = 0; row < rows(); ++row) {
    const Constraint constraint = RowConstraint(row);
    if (constraint.kind == ConstraintKind::kObstacle) {
      const double r = ellipses_[Index(row % StepRows() - kObstacleRow)].smaller_semi_axis;
      raise(r * std::sqrt(g[Index(row)]), r, kNone, constraint);
    } else {
      raise(g[Index(row)], row_bounds_.lo[Index(row)], row_bounds_.hi[Index(row)], constraint);
    }
  }
  for (int k = 0; k < variables(); ++k) {
    const int i = k / kStepVariables, j = k % kStepVariables;
    const Constraint constraint =
        j < kInputs ? Constraint{.kind = ConstraintKind::kInput, .index = j, .step = i}
                    : Constraint{.kind = ConstraintKind::kState, .index = j - kInputs, .step = i + 1};
    raise(x[Index(k)], variable_bounds_.lo[Index(k)], variable_bounds_.hi[Index(k)], constraint);
  }
  return largest;
}

}  // namespace control
