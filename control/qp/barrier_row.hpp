// A row of an OcpQp in the interior-point method: its bounds as equations, and its part of the Newton step.
//
// Each bound is an equation with a distance t ≥ 0 and a multiplier λ ≥ 0,
//   C x + D u + ε − lo = t_lo,   hi + ε − C x − D u = t_hi,   ε = t_ε,   λ t = target,
// the third only in soft rows with σ > 0, and the stationarity with respect to a soft row's slack is
//   ρ ε + σ − λ_lo − λ_hi − λ_ε = 0.
// Eliminating dt, dλ and dε from the Newton equations leaves, for each row, a gradient γ and, on C dx + D du, a
// curvature
//   w = w_lo + w_hi − (w_lo − w_hi)² / s,   s = ρ + w_lo + w_hi + w_ε,
//   w_lo = λ_lo / (t_lo + δ λ_lo), w_hi and w_ε likewise
// (the quotient in soft rows only, where w is computed as (4 w_lo w_hi + (ρ + w_ε) (w_lo + w_hi)) / s, which
// cancels no digits; w_ε = 0 where σ = 0). δ regularises only the step,
// dt = C dx + D du + dε + residual + δ dλ: it keeps w ≤ 1/δ and so the digits of P, and vanishes with dλ.
#pragma once

#include <algorithm>
#include <cmath>

#include "control/qp/point.hpp"
#include "control/qp/problem.hpp"
#include "control/qp/rows.hpp"

namespace control {

// One bound of a row, or of its slack.
struct BarrierSide {
  static constexpr double kDualRegularisation = 1e-10;  // δ

  bool present = false;
  double bound = 0.0;  // bound on the deviation from the unconstrained optimum
  double t = 1.0;
  double lambda = 0.0;
  double inverse_t = 0.0;  // 1 / (t + δ λ)
  double w = 0.0;          // λ / (t + δ λ)
  double residual = 0.0;   // distance − t
  double y = 0.0;          // the part of dλ that does not depend on dx, du, dε
  double dt = 0.0;
  double dlambda = 0.0;

  void ComputeCurvature() {
    if (!present) return;
    inverse_t = 1.0 / (t + kDualRegularisation * lambda);
    w = lambda * inverse_t;
  }
  void SetTarget(double target, bool second_order) {
    if (!present) return;
    const double cross = second_order ? dt * dlambda : 0.0;
    y = (target - cross - lambda * t) * inverse_t - w * residual;
  }
  void Move(double alpha) {
    if (!present) return;
    t += alpha * dt;
    lambda += alpha * dlambda;
  }
};

// The effect of a step on all bounds together.
struct BarrierStep {
  double longest = kNoBound;                     // length of the step at which the first t or λ is zero
  double first_order = 0.0, second_order = 0.0;  // derivatives of Σ λ t in the step's length

  void Add(BarrierSide& side, double distance_step) {
    if (!side.present) return;
    side.dlambda = side.y - side.w * distance_step;
    side.dt = distance_step + side.residual + BarrierSide::kDualRegularisation * side.dlambda;
    if (side.t + longest * side.dt < 0.0) longest = -side.t / side.dt;
    if (side.lambda + longest * side.dlambda < 0.0) longest = -side.lambda / side.dlambda;
    first_order += side.t * side.dlambda + side.lambda * side.dt;
    second_order += side.dt * side.dlambda;
  }
};

struct BarrierRow {
  BarrierSide lo, hi;
  BarrierSide slack;  // ε ≥ 0, present where σ > 0
  double epsilon = 0.0;
  double r_epsilon = 0.0;  // gradient of the Lagrangian with respect to ε
  double inverse_s = 0.0;  // 1 / s; 0 for a hard row
  double y = 0.0;          // y_lo + y_hi + y_ε − r_epsilon
  double w = 0.0;
  double depsilon = 0.0;

  // Takes over the row's bounds for deviations. Returns their number.
  template <typename Row>
  int Begin(const Row& row, double shifted_lo, double shifted_hi) {
    *this = BarrierRow{};
    lo.present = row.has_lo();
    lo.bound = shifted_lo;
    hi.present = row.has_hi();
    hi.bound = shifted_hi;
    slack.present = row.exact();
    return static_cast<int>(lo.present) + static_cast<int>(hi.present) + static_cast<int>(slack.present);
  }

  // Sets the starting point for a value of C x + D u and complementarity μ. Every distance is at least `share` of the
  // row's width (of 1 in a wider row) plus 1e-3, every λ at least `at_least`. Where σ > 0 the slack starts stationary,
  // with λ_ε ε = μ, so λ_lo + λ_hi must stay below σ + ρ ε.
  template <typename Row>
  void Start(const Row& row, double value, double share, double mu, const RowMultiplier& at_least) {
    constexpr double kLeastShare = 0.1;  // share of σ reserved for λ_ε, at most
    const double least = share * std::clamp(row.hi - row.lo, 0.0, 1.0) + 1e-3;
    const auto side = [&](BarrierSide& s, double distance, double lambda) {
      s.t = std::max(distance, least);
      s.lambda = s.present ? std::max(lambda, mu / s.t) : 0.0;
    };
    side(lo, value - lo.bound, at_least.lo);
    side(hi, hi.bound - value, at_least.hi);
    double lambda = lo.lambda + hi.lambda;
    if (!row.exact()) {
      epsilon = row.rho > 0.0 ? lambda / row.rho : 0.0;
      return;
    }
    const double violation = std::max(0.0, detail::Violation(lo.bound, hi.bound, value));
    const double most = row.sigma + row.rho * violation - std::min(kLeastShare * row.sigma, mu / violation);
    if (lambda > most) {
      lo.lambda *= most / lambda;
      hi.lambda *= most / lambda;
      lambda = most;
    }
    const double half = 0.5 * (row.sigma - lambda);
    const double root = std::sqrt(half * half + row.rho * mu);
    slack.lambda = half > 0.0 ? half + root : row.rho * mu / (root - half);
    slack.t = epsilon = mu / slack.lambda;
  }

  // Computes w and the quantities it consists of.
  template <typename Row>
  void ComputeCurvature(const Row& row) {
    lo.ComputeCurvature();
    hi.ComputeCurvature();
    slack.ComputeCurvature();
    w = lo.w + hi.w;
    if (!row.soft()) return;
    const double slack_w = row.rho + slack.w;
    const double s = slack_w + w;
    inverse_s = s > 0.0 ? 1.0 / s : 0.0;
    w = (4.0 * lo.w * hi.w + slack_w * w) * inverse_s;
  }

  // Returns the gradient γ of a step towards λ t = target, optionally with the second-order term of the previous step.
  double Gradient(double target, bool second_order) {
    lo.SetTarget(target, second_order);
    hi.SetTarget(target, second_order);
    slack.SetTarget(target, second_order);
    y = lo.y + hi.y + slack.y - r_epsilon;
    return hi.y - lo.y + (lo.w - hi.w) * y * inverse_s;
  }

  // Computes dt, dλ and dε of a step with C dx + D du = dg.
  void ComputeStep(double dg, BarrierStep& step) {
    depsilon = (y - (lo.w - hi.w) * dg) * inverse_s;
    step.Add(lo, dg + depsilon);
    step.Add(hi, -dg + depsilon);
    step.Add(slack, depsilon);
  }

  void Move(double alpha) {
    lo.Move(alpha);
    hi.Move(alpha);
    slack.Move(alpha);
    epsilon += alpha * depsilon;
  }
};

}  // namespace control
