// A driver who keeps to a desired speed and a distance to whom is ahead: the intelligent driver model (Treiber, Hennecke
// and Helbing, "Congested traffic states in empirical observations and microscopic simulations", Phys. Rev. E 62, 2000),
// which brakes no harder than kHardestByFollower.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace sim {

inline constexpr double kFollowerHeadway = 1.2;       // [s]
inline constexpr double kFollowerGap = 2.0;           // kept at standstill [m]
inline constexpr double kFollowerAcceleration = 1.5;  // [m/s²]
inline constexpr double kFollowerDeceleration = 2.5;  // that is comfortable [m/s²]
inline constexpr double kHardestByFollower = 6.0;     // deceleration [m/s²]

struct Leader {
  double gap = 0.0;    // from the follower's front to the leader's rear [m]
  double speed = 0.0;  // in the follower's direction, negative if it comes towards it [m/s]
};

// Acceleration [m/s²] of a follower at `speed` >= 0 that wants `desired_speed` > 0.
[[nodiscard]] inline double FollowerAcceleration(double speed, double desired_speed,
                                                 const std::optional<Leader>& leader) {
  const double share = speed / desired_speed;
  double demand = 1.0 - share * share * share * share;
  if (leader) {
    if (leader->gap <= 0.0) return -kHardestByFollower;
    const double root = std::sqrt(kFollowerAcceleration * kFollowerDeceleration);
    const double wanted = kFollowerGap + std::max(0.0, speed * kFollowerHeadway +
                                                           speed * (speed - leader->speed) / (2.0 * root));
    demand -= (wanted / leader->gap) * (wanted / leader->gap);
  }
  return std::max(kFollowerAcceleration * demand, -kHardestByFollower);
}

}  // namespace sim
