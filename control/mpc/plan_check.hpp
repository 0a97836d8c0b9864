// The last check of a plan before it is followed: its inputs are simulated with the nonlinear model, and the vehicle's
// whole rectangle is compared with obstacles, road and friction, without margins: a failure here would be a real one.
//
// Behind a plan there must be a stop: after its first inputs, the vehicle brakes along the plan's path (stop_path.hpp) until
// it stands, and touches nothing whatever the others do within the bounds of occupancy.hpp. As long as each plan that is
// followed has one, there is always a way to a standstill without a fault of the vehicle's (docs/safety.md).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/road/road_profile.hpp"
#include "control/road/stop_path.hpp"
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
  double mu = 0.7;                    // assumed friction coefficient
  double t_s = 0.05;                  // [s], at most 0.06
  double stop_deceleration = 3.0;     // [m/s²], > 0
  double hardest_deceleration = 6.0;  // [m/s²], ≥ stop_deceleration
  double jerk = 30.0;                 // [m/s³]
};

struct StopVerdict {
  std::optional<double> deceleration;            // of the stop [m/s²]; none if no stop is clear
  bool lasts = false;                            // a stop that begins 0.5 s later is clear, too
  std::optional<ConstraintViolation> violation;  // then what stands in the way of the hardest
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
  [[nodiscard]] std::optional<ConstraintViolation> Validate(std::span<const Input> u);

  // Finds the earliest and mildest stop behind the inputs that were validated last, whose plan leads on along `beyond`. Does
  // not allocate.
  [[nodiscard]] StopVerdict FindStop(const LateralPath& beyond = {});
  // Likewise for a vehicle that brakes at once along `path`; it accelerates by `acceleration` [m/s²] so far. It need not
  // stop as far before things as behind a plan, lest noise take the last stop away.
  [[nodiscard]] StopVerdict FindStop(const StopPath& path, double acceleration) const;
  // What the tyres can give now, along `path`, of the deceleration of a stop; without one, of the hardest [m/s²].
  [[nodiscard]] double Deceleration(const StopPath& path, const std::optional<double>& stop) const;

  void Reconfigure(double stop_deceleration);
  [[nodiscard]] const Footprint& footprint() const { return settings_.footprint; }

 private:
  // How near the vehicle must come to touch an object.
  struct Reach {
    Eigen::Vector2d centre{0.0, 0.0};  // of the object now [m]
    double far = 0.0;                  // distance of the centres above which they are apart [m]
    bool stands = false;
    bool touched = false;  // the vehicle touches it already
  };
  struct Braking {
    double distance = 0.0;      // along the path [m]
    double speed = 0.0;         // [m/s]
    double acceleration = 0.0;  // [m/s²]
    double time = 0.0;          // from now [s]
  };
  [[nodiscard]] double OffRoad(const State& z, double& s) const;
  [[nodiscard]] double MostOffRoad(const State& z, const RouteProjection& centre) const;
  [[nodiscard]] double BeyondGrip(const State& z, const Input& u) const;
  [[nodiscard]] double Brakes(double speed, double curvature, double deceleration) const;
  // The step that ends `time` [s] from now.
  [[nodiscard]] int StepAt(double time) const;
  [[nodiscard]] std::optional<ConstraintViolation> Contact(const State& z, double s, double time) const;
  // True if the vehicle can touch nothing until `after` steps of the plan, of which `checked` have been; updates `checked`
  // and s, its place there.
  [[nodiscard]] bool ClearUntil(std::size_t after, std::size_t& checked, double& s,
                                std::optional<ConstraintViolation>& contact) const;
  // The mildest stop that begins after this number of steps of the plan, at arc length s.
  [[nodiscard]] StopVerdict StopAfter(std::size_t after, double s) const;
  [[nodiscard]] StopVerdict Mildest(const StopPath& path, const Braking& from, double reserve) const;
  [[nodiscard]] std::optional<ConstraintViolation> Brake(const StopPath& path, Braking from,
                                                         double deceleration, double reserve) const;

  PlanCheckSettings settings_;
  DiscreteModel model_;
  const RoadProfile* profile_;
  RoadObjects objects_;
  State z_ = State::Zero();
  double s_ = 0.0;
  std::span<const Obstacle> obstacles_;
  std::array<Reach, RoadObjects::kMost> reach_{};  // of each object
  double off_road_ = 0.0;  // largest distance beyond the road's edge that counts as none [m]
  double a_y_ = 0.0;       // [m/s²]
  double mu_;
  std::vector<State> predicted_;
  std::vector<double> accelerations_;  // of the inputs that lead to them [m/s²]
  StopPath path_;                      // along predicted_
};

}  // namespace control
