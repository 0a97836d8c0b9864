// Steers a vehicle that brakes to a stop along its path when there are no more plans, by pure pursuit (Coulter,
// CMU-RI-TR-92-01) with the single-track model's steady state in place of its kinematics:
//
//   κ = 2 y_t / d²            circle tangent to the travel direction at the vehicle, through a path point at distance d
//
// with δ and the sideslip angle from steady_cornering.hpp. The path is the reference, shifted sideways to where the
// last plan ends: it runs along the road and does not steer back into what the plan avoided.
#pragma once

#include <span>

#include "control/road/odometer.hpp"
#include "control/road/time_reference.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

struct PathStopSettings {
  VehicleParameters vehicle;
  double t_s = 0.05;               // [s]
  double max_steering_rate = 0.5;  // for the transition of δ from the last plan to the path [rad/s]
  double look_ahead_time = 0.6;    // d = max(look_ahead_time υ, min_look_ahead) [s]
  double min_look_ahead = 5.0;     // [m]
};

class PathStop {
 public:
  // `reference` must outlive this object.
  PathStop(const PathStopSettings& settings, const TimeReference& reference)
      : settings_(settings), reference_(&reference) {}

  // δ of this cycle [rad] for a path `offset` [m] left of the reference; `applied` is δ of the previous cycle. Below
  // kMinSteeringSpeed the wheels are held.
  [[nodiscard]] double Steering(const RouteMotion& motion, double offset, double applied) const;

  // Distance [m] by which `plan` ends left of the reference; its N + 1 states begin where the vehicle is.
  [[nodiscard]] double OffsetOf(std::span<const State> plan, const RouteMotion& motion) const;

 private:
  PathStopSettings settings_;
  const TimeReference* reference_;
};

}  // namespace control
