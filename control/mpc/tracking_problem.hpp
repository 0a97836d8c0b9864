// The tracking problem of one control step, independent of the solver: the manoeuvre among the things on the road
// (traffic_planner.hpp), the reference along its path, and the rows that keep the vehicle's rectangle on the road and out
// of obstacles.
//
//   tracking.Begin(z, s, obstacles);    // once per step
//   tracking.BuildConstraints(z_hat);   // once for each new predicted trajectory
//   for (const BodyRow& row : tracking.rows(i)) …
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/mpc/lpv_affine_settings.hpp"
#include "control/road/halfspace.hpp"
#include "control/road/road_profile.hpp"
#include "control/traffic/progress_reference.hpp"
#include "control/traffic/traffic_planner.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// lo ≤ normalᵀ p ≤ hi, where p is the position in the map of the point `fixed` of the vehicle's body.
struct BodyRow {
  Eigen::Vector2d normal;
  Eigen::Vector2d fixed;
  double lo = 0.0;
  double hi = 0.0;
  Constraint constraint;
};

class TrackingProblem {
 public:
  static constexpr std::size_t kMostObstacles = 6;  // that have rows in one step: the nearest ones
  static constexpr std::size_t kMostRows = 2 + 2 * kMostObstacles;  // per step

  // `profile` must outlive the problem.
  TrackingProblem(const VehicleParameters& vehicle, const RoadProfile& profile,
                  const LpvAffineSettings& settings);

  // Bounds the friction coefficient from now on, besides that of the settings.
  void SetFrictionLimit(double mu_limit);
  // `s`: where the search for the vehicle's place on the road begins [m].
  void Begin(const State& z, double s, std::span<const Obstacle> obstacles,
             const Disturbance& disturbance = {}, bool slow_down = false);
  void BuildConstraints(std::span<const State> z_hat);
  // Forgets all decisions.
  void Reset();

  [[nodiscard]] const State& z() const { return z_; }  // as given to Begin, but ψ within π of the road's
  [[nodiscard]] const Manoeuvre& manoeuvre() const { return *manoeuvre_; }
  [[nodiscard]] ManoeuvreStatus manoeuvre_status() const;
  // Highest speed at step i [m/s].
  [[nodiscard]] double SpeedLimit(std::size_t i) const;
  // True (almost) at standstill with nowhere to go; hysteresis keeps noise from ending it.
  [[nodiscard]] bool waiting() const { return waiting_; }
  // Fills in the plan of a waiting vehicle: the brake holds it whatever the slope, the wheels stay as they are.
  void Hold(const Input& u_previous, std::span<State> z, std::span<Input> u) const;
  [[nodiscard]] std::span<const State> reference() const { return z_ref_; }
  [[nodiscard]] std::span<const Input> reference_input() const { return u_ref_; }
  // Rows of step i ≥ 1, valid until the next BuildConstraints.
  [[nodiscard]] std::span<const BodyRow> rows(std::size_t i) const { return {rows_[i].data(), counts_[i]}; }

 private:
  void Place(const State& z, double s);
  [[nodiscard]] double LimitAt(double s) const;
  void Add(std::size_t i, const BodyRow& row);
  void AddRoad(std::size_t i, const State& z_hat, const RouteProjection& place);
  void AddObstacles(std::size_t i, const State& z_hat);
  // The half-space of road object k at step i; none if it has no effect there.
  [[nodiscard]] std::optional<HalfSpace> Outside(std::size_t k, std::size_t i, const State& z_hat) const;

  LpvAffineSettings settings_;
  double grip_;  // acceleration that the tyres can give [m/s²]
  const RoadProfile* profile_;
  ProgressReference progress_;
  TrafficPlanner traffic_;

  State z_ = State::Zero();
  RoadPosition place_;
  bool waiting_ = false;
  bool rolled_ = false;  // although it was waiting
  double slope_ = 0.0;   // acceleration that pulls the vehicle along the road [m/s²]
  std::span<const Obstacle> obstacles_;
  const Manoeuvre* manoeuvre_;
  std::size_t first_stop_ = RoadObjects::kMost;  // road object before which the vehicle stops; kMost: none
  std::vector<State> z_ref_;
  std::vector<Input> u_ref_;
  std::vector<double> s_ref_;
  std::vector<std::array<BodyRow, kMostRows>> rows_;
  std::vector<std::size_t> counts_;
};

}  // namespace control
