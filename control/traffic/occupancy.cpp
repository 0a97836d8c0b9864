#include "control/traffic/occupancy.hpp"

#include <algorithm>
#include <cmath>

#include "control/traffic/stop_line.hpp"

namespace control {
namespace {

constexpr double kReaction = 1.0;       // [s]
constexpr double kStands = 0.01;        // speed at most [m/s]
constexpr double kBrakesAtLeast = 3.0;  // [m/s²]

// Distance that is covered in the time t by braking from `speed` to a stop.
double BrakingWay(double speed, double deceleration, double t) {
  const double until = std::min(std::max(t, 0.0), speed / deceleration);
  return until * (speed - 0.5 * deceleration * until);
}

}  // namespace

double TimeToNearest(const Obstacle& obstacle, const RoadObject& object, double time,
                     const Eigen::Vector2d& position, double s, double s_0) {
  const Eigen::Vector2d velocity(obstacle.velocity_X, obstacle.velocity_Y);
  const double speed = object.crosses ? velocity.norm() : std::abs(object.speed);
  if (speed <= kStands) return 0.0;
  const bool gives_way = !object.crosses && (object.ComesTowards() || object.s < s_0);
  const double shortest = BrakingWay(speed, StopLine::kHardest, time);
  const double longest =
      gives_way ? speed * std::min(time, kReaction) + BrakingWay(speed, kBrakesAtLeast, time - kReaction)
                : speed * time;
  const double wanted = object.crosses
                            ? velocity.dot(position - Eigen::Vector2d(obstacle.X, obstacle.Y)) / speed
                            : (object.speed > 0.0 ? s - object.s : object.s - s);
  return std::clamp(wanted, shortest, longest) / speed;
}

}  // namespace control
