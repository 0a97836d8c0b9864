#include "control/mpc/trust_region.hpp"

namespace control {

double TrustRegion::SchedulingError(const State& z, const State& z_hat) const {
  double largest = 0.0;
  for (std::size_t j = 0; j < kScheduledStates.size(); ++j) {
    const double error = std::abs(z[kScheduledStates[j]] - z_hat[kScheduledStates[j]]);
    largest = std::max(largest, error / radii_[static_cast<Eigen::Index>(j)]);
  }
  return largest;
}

void TrustRegion::Adapt(double error) {
  constexpr double kPoor = 0.5, kGood = 0.25;      // shares of the present radii
  constexpr double kNarrower = 0.8, kWider = 1.1;  // factors per step
  constexpr double kNarrowest = 0.5, kWidest = 2.0;
  const double mismatch = error / scale_;
  const double factor = mismatch > kPoor ? kNarrower : (mismatch < kGood ? kWider : 1.0);
  scale_ = std::clamp(factor * scale_, kNarrowest, kWidest);
}

double TrustRegion::Measure(const Prediction& prediction, std::size_t last_state, std::size_t last_input,
                            bool bounded, Plan& plan) const {
  double largest = 0.0;
  plan.active_trust_rows = 0;
  plan.largest_slack = 0.0;
  const auto visit = [&](double value, double predicted, std::size_t j) {
    const double deviation = std::abs(value - predicted) / radii_[static_cast<Eigen::Index>(j)];
    largest = std::max(largest, deviation);
    if (!bounded) return;
    if (deviation >= scale_ * (1.0 - 1e-6)) ++plan.active_trust_rows;
    plan.largest_slack = std::max(plan.largest_slack, deviation / scale_ - 1.0);
  };
  for (std::size_t i = 0; i <= last_input; ++i) {
    visit(plan.u[i][kDelta], prediction.u()[i][kDelta], kScheduledDelta);
  }
  for (std::size_t i = 1; i <= last_state; ++i) {
    for (std::size_t j = 0; j < kScheduledStates.size(); ++j) {
      visit(plan.z[i][kScheduledStates[j]], prediction.z()[i][kScheduledStates[j]], j);
    }
  }
  return largest;
}

}  // namespace control
