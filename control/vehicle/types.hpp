// The quantities between a measured state and a command, in SI units and radians.
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace control {

// z = [X Y υ ν ψ ω] (paper, eq:dynamic_model): position of the centre of gravity in the map [m], longitudinal and
// lateral speed in the body frame [m/s], yaw angle [rad], yaw rate [rad/s].
inline constexpr int kStates = 6;
enum StateIndex : int { kX, kY, kUpsilon, kNu, kPsi, kOmega };
using State = Eigen::Matrix<double, kStates, 1>;

// u = [δ a]: steering angle of the front wheels [rad], longitudinal acceleration [m/s²].
inline constexpr int kInputs = 2;
enum InputIndex : int { kDelta, kAcceleration };
using Input = Eigen::Matrix<double, kInputs, 1>;

// Side on which an obstacle is passed, seen in driving direction (paper, assum_1).
enum class PassingSide { kUnknown, kLeft, kRight };

enum class ObstacleShape { kEllipse, kBox };
enum class ObstacleClass { kUnknown, kStatic, kVehicle, kCycle, kPedestrian };

// Ellipse or rectangle about (X, Y) with semi-axes or half sides r_x, r_y [m], the first along `heading` [rad]; velocity
// in the map [m/s].
struct Obstacle {
  int id = 0;
  double X = 0.0;
  double Y = 0.0;
  double r_x = 1.0;
  double r_y = 1.0;
  double heading = 0.0;
  double velocity_X = 0.0;
  double velocity_Y = 0.0;
  PassingSide side = PassingSide::kUnknown;
  ObstacleShape shape = ObstacleShape::kEllipse;
  ObstacleClass object_class = ObstacleClass::kUnknown;
};

// Distances from the reference path to the road's edges [m]: the paper's R_2 (left, positive) and R_1 (right,
// negative).
struct RoadBounds {
  double left = 4.0;
  double right = -4.0;
};

// Wraps an angle to (-π, π].
[[nodiscard]] double WrapAngle(double angle);

// The angle, plus or minus full turns, that is within π of `near`.
[[nodiscard]] double UnwrapAngle(double angle, double near);

// A step, stage or row as an index of a container.
[[nodiscard]] inline std::size_t Index(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace control
