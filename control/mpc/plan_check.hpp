// The last look at a plan before it is followed: its inputs are driven through the nonlinear model, and the vehicle's
// whole rectangle is held against obstacles, road and friction. No margins: what fails here would happen.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/road/road_profile.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

struct PlanCheckSettings {
  VehicleParameters vehicle;
  Footprint footprint;
  double mu = 0.7;    // friction coefficient that is reckoned with
  double t_s = 0.05;  // [s], at most 0.06
};

class PlanCheck {
 public:
  // `course` must outlive it.
  PlanCheck(const PlanCheckSettings& settings, const RoadProfile& course);

  // What goes wrong first, if the vehicle at `z` is given these inputs, with the
  // obstacles at constant velocity: an obstacle is touched (kObstacle; amount: how far the
  // rectangle reaches into it, about [m]), a corner leaves the road [m], or the friction coefficient does not suffice [m/s²].
  // What is out of bounds by as much at the beginning is not the plan's fault. Does not allocate.
  [[nodiscard]] std::optional<ConstraintViolation> Judge(const State& z, std::span<const Input> u,
                                                         std::span<const Obstacle> obstacles);
  // The vehicle may be anywhere: its place on the course is looked for anew.
  void Reset() { s_.reset(); }

 private:
  [[nodiscard]] double OffRoad(const State& z, double& s) const;
  [[nodiscard]] double BeyondGrip(const State& z, const Input& u) const;
  [[nodiscard]] double Touched(const State& z, const Obstacle& obstacle) const;

  PlanCheckSettings settings_;
  DiscreteModel model_;
  const RoadProfile* course_;
  std::optional<double> s_;  // of the vehicle, at the last judgement
};

}  // namespace control
