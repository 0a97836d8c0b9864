// The last check of a plan before it is followed: its inputs are simulated with the nonlinear model, and the vehicle's
// whole rectangle is compared with obstacles, road and friction, without margins: a failure here would be a real one.
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
  double mu = 0.7;    // assumed friction coefficient
  double t_s = 0.05;  // [s], at most 0.06
};

class PlanCheck {
 public:
  // `profile` must outlive the check.
  PlanCheck(const PlanCheckSettings& settings, const RoadProfile& profile);

  // Returns the first violation if the vehicle at `z` is given these inputs and the obstacles keep their velocities:
  // contact with an obstacle (amount: roughly how far the rectangle reaches into it [m]), a corner off the road [m], or
  // more acceleration than friction allows [m/s²]. Road and friction count only where the excess is more than 0.02 m or
  // 0.3 m/s² above the initial one, which is not the plan's fault. The search for the vehicle's place on the road
  // begins at `s` [m]. Does not allocate.
  [[nodiscard]] std::optional<ConstraintViolation> Validate(const State& z, double s,
                                                            std::span<const Input> u,
                                                            std::span<const Obstacle> obstacles) const;

 private:
  [[nodiscard]] double OffRoad(const State& z, double& s) const;
  [[nodiscard]] double BeyondGrip(const State& z, const Input& u) const;
  [[nodiscard]] double Touched(const State& z, const Obstacle& obstacle) const;

  PlanCheckSettings settings_;
  DiscreteModel model_;
  const RoadProfile* profile_;
};

}  // namespace control
