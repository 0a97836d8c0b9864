// Steers a vehicle that brakes to a stop along its path when there are no more plans: by pure pursuit (Coulter,
// CMU-RI-TR-92-01) with the single-track model's steady state in the place of its kinematics:
//
//   κ = 2 y_t / d²            circle through the vehicle, along its course, and a point of the path at distance d
//
// with δ and the angle between heading and course of steady_cornering.hpp. The path is the reference, shifted sideways to where
// the last plan ends: the road's course, without steering back into what the plan went round. Without a measured
// state the vehicle's place is reckoned from the commands.
#pragma once

#include <span>

#include "control/road/time_reference.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

struct PathStopSettings {
  VehicleParameters vehicle;
  double t_s = 0.05;                // [s]
  double max_steering_rate = 0.5;   // by which δ comes from the last plan's to the path's [rad/s]
  double look_ahead_time = 0.6;     // d = max(look_ahead_time υ, min_look_ahead) [s]
  double min_look_ahead = 5.0;      // [m]
  double min_steering_speed = 0.5;  // below it the wheels are held [m/s]
};

class PathStop {
 public:
  // `reference` must outlive it.
  PathStop(const PathStopSettings& settings, const TimeReference& reference);

  // The vehicle is at `z`, beside point k of the reference.
  void Start(const State& z, int k);
  // One cycle of t_s later: at `measured`, or, if that is null, where `applied` has led it.
  void Advance(const State* measured, const Input& applied);
  // The path ends like this plan, N + 1 states that begin where the vehicle is.
  void Follow(std::span<const State> plan);
  // δ of this cycle [rad]; `applied` is that of the cycle before.
  [[nodiscard]] double Steering(double applied) const;

  [[nodiscard]] int place() const { return k_; }           // nearest point of the reference
  [[nodiscard]] double speed() const { return speed_; }    // as measured or reckoned [m/s], ≥ 0
  [[nodiscard]] double offset() const { return offset_; }  // of the path, left of the reference [m]

 private:
  [[nodiscard]] State At(int k) const;
  [[nodiscard]] int Nearest(const Eigen::Vector2d& p, int from) const;

  PathStopSettings settings_;
  const TimeReference* reference_;
  Eigen::Vector2d p_ = Eigen::Vector2d::Zero();
  double psi_ = 0.0;
  double course_ = 0.0;  // direction of the velocity
  double speed_ = 0.0;
  int k_ = 0;
  double offset_ = 0.0;
};

}  // namespace control
