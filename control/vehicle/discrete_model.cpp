#include "control/vehicle/discrete_model.hpp"

#include <array>

namespace control {
namespace {

// The classic method: stage j is evaluated at z + a_j t_s k_{j−1} and has the weight b_j.
constexpr std::array<double, 4> kA{0.0, 0.5, 0.5, 1.0};
constexpr std::array<double, 4> kB{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};

}  // namespace

State DiscreteModel::Step(const State& z, const Input& u) const {
  State k = State::Zero();
  State next = z;
  Angles angles = model_.AnglesAt(z, u);
  for (std::size_t j = 0; j < kA.size(); ++j) {
    const State stage = z + kA[j] * t_s_ * k;
    if (j > 0) angles.Turn(stage);
    k = model_.Derivative(stage, u, angles);
    next += kB[j] * t_s_ * k;
  }
  return next;
}

AffineModel DiscreteModel::Expand(const State& z, const Input& u) const {
  using Square = decltype(LinearModel::A);
  using Tall = decltype(LinearModel::B);
  State k = State::Zero();
  Square dk_dz = Square::Zero();
  Tall dk_du = Tall::Zero();
  State next = z;
  Angles angles = model_.AnglesAt(z, u);
  AffineModel model{.linear = {.A = Square::Identity(), .B = Tall::Zero()}, .c = State::Zero()};
  for (std::size_t j = 0; j < kA.size(); ++j) {
    const double h = kA[j] * t_s_;
    const State stage = z + h * k;
    if (j > 0) angles.Turn(stage);
    const auto [f, d] = model_.Linearise(stage, u, angles);
    k = f;
    dk_du = d.B + h * d.A * dk_du;
    dk_dz = d.A + h * d.A * dk_dz;
    next += kB[j] * t_s_ * k;
    model.linear.A += kB[j] * t_s_ * dk_dz;
    model.linear.B += kB[j] * t_s_ * dk_du;
  }
  model.c = next - model.linear.A * z - model.linear.B * u;
  return model;
}

}  // namespace control
