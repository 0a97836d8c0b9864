// The derivatives of AffineNmpcProblem's rows, and their sparsity patterns.
#include "control/nmpc/affine_nmpc_problem.hpp"
#include "control/vehicle/geometry.hpp"

namespace control {

namespace {

using Eigen::Vector2d;

// The states in which F is nonlinear, and those of them that move the vehicle in its own frame, all but ψ.
constexpr std::array kCurved{kUpsilon, kNu, kPsi, kOmega};
constexpr std::array kDynamic{kUpsilon, kNu, kOmega};

// The non-zeros of ∂F/∂z: the position affects only itself, and the heading only itself and the position.
constexpr bool Couples(int row, int column) {
  if (column <= kY) return row == column;
  return column != kPsi || row <= kY || row == kPsi;
}

}  // namespace

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

// The Hessian of λᵀ F. The position adds nothing. A rotation by ψ only rotates the motion in the map, so the second
// derivatives in ψ are those of first order, rotated. The rest comes from one-sided differences.
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
  // The entries of z_i: the cost, the soft rows and the model of the step that starts there.
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
        by_body -= multiplier * body.normal.dot(Rotate(state[kPsi], body.fixed));
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
    const double changes = i + 1 < horizon() ? 2.0 : 1.0;  // number of changes that involve u_i
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
