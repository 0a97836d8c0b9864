// The trust region of the scheduling variables p = [υ ν ψ δ] (paper, eq:LPV_MPC): |p_j − p̂_j| ≤ e_j.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "control/mpc/controller.hpp"
#include "control/mpc/prediction.hpp"
#include "control/vehicle/types.hpp"

namespace control {

// The scheduling variables in the order of p: three states, then δ.
inline constexpr std::array kScheduledStates{kUpsilon, kNu, kPsi};
inline constexpr std::size_t kScheduledDelta = kScheduledStates.size();

class TrustRegion {
 public:
  explicit TrustRegion(const Eigen::Vector4d& radii) : radii_(radii) {}

  // e_j, scaled by Adapt.
  [[nodiscard]] double Radius(std::size_t j) const { return scale_ * radii_[static_cast<Eigen::Index>(j)]; }
  // max_j |p_j − p̂_j| / e_j of the three states against their prediction, in unscaled radii.
  [[nodiscard]] double SchedulingError(const State& z, const State& z_hat) const;
  // Widens the trust region after accurate predictions and narrows it after poor ones. `error` is a SchedulingError.
  void Adapt(double error);
  void Reset() { scale_ = 1.0; }

  // Compares the scheduling variables of the plan's states 1..`last_state` and inputs 0..`last_input` with the
  // prediction. Returns the largest deviation in unscaled radii. If `bounded`, sets the plan's number of active
  // trust-region rows and its largest slack, else both to 0.
  double Measure(const Prediction& prediction, std::size_t last_state, std::size_t last_input, bool bounded,
                 Plan& plan) const;

 private:
  Eigen::Vector4d radii_;
  double scale_ = 1.0;
};

}  // namespace control
