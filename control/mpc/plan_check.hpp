// The last check of a plan before it is followed: its inputs are simulated with the nonlinear model, and the vehicle's
// whole rectangle is compared with obstacles, road and friction, without margins: a failure here would be a real one.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/road/road_profile.hpp"
#include "control/traffic/road_objects.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/disturbance.hpp"
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

  // Sets the start of the plans to be validated: the vehicle at `z`, whose place on the road is searched for from `s` [m]
  // on, and the obstacles. The disturbance is taken to last; the friction coefficient is the lesser of the assumed one and
  // `mu_limit`. Does not allocate.
  void Begin(const State& z, double s, std::span<const Obstacle> obstacles,
             const Disturbance& disturbance = {}, double mu_limit = kNoLimit);

  // Returns the first violation if the vehicle is given these inputs and the obstacles that matter (road_objects.hpp) move
  // on along the road, or straight across it: contact with an obstacle (amount: roughly how far the rectangle reaches
  // into it [m]), a corner off the road [m], or more acceleration than friction allows [m/s²]. Road and friction count
  // only where the excess is more than 0.02 m or 0.3 m/s² above the initial one, which is not the plan's fault. Does not allocate.
  [[nodiscard]] std::optional<ConstraintViolation> Validate(std::span<const Input> u) const;

 private:
  [[nodiscard]] double OffRoad(const State& z, double& s) const;
  [[nodiscard]] double BeyondGrip(const State& z, const Input& u) const;

  PlanCheckSettings settings_;
  DiscreteModel model_;
  const RoadProfile* profile_;
  RoadObjects objects_;
  State z_ = State::Zero();
  double s_ = 0.0;
  std::span<const Obstacle> obstacles_;
  double a_y_ = 0.0;  // [m/s²]
  double mu_;
};

}  // namespace control
