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

// The scheduled quantities in the order of p: three states, then δ.
inline constexpr std::array kScheduledStates{kUpsilon, kNu, kPsi};
inline constexpr std::size_t kScheduledDelta = kScheduledStates.size();

class TrustRegion {
 public:
  explicit TrustRegion(const Eigen::Vector4d& radii) : radii_(radii) {}

  // e_j, scaled by Adapt.
  [[nodiscard]] double Radius(std::size_t j) const { return scale_ * radii_[static_cast<Eigen::Index>(j)]; }
  // max_j |p_j − p̂_j| / e_j of a state against its prediction, without the scale.
  [[nodiscard]] double SchedulingError(const State& z, const State& z_hat) const;
  // Where predictions come true the trust region may be wide; where they do not, the model about them deserves less
  // trust. `error` is a SchedulingError.
  void Adapt(double error);
  void Reset() { scale_ = 1.0; }

  // Visits the scheduling variables of a plan from its states 1..`last_state` and its inputs 0..`last_input` against the
  // prediction. Returns the largest deviation in unscaled radii; with `bounded`, counts the plan's active rows of the
  // trust region and computes its largest slack.
  double Measure(const Prediction& prediction, std::size_t last_state, std::size_t last_input, bool bounded,
                 Plan& plan) const;

 private:
  Eigen::Vector4d radii_;
  double scale_ = 1.0;
};

}  // namespace control
