// The tracking problem of one control step, independent of the solver: the reference from the vehicle's place on, the
// passing side of each obstacle or the place to stop, and the rows that keep the vehicle's rectangle on the road and
// out of obstacles. The decisions are kept from step to step.
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
#include "control/road/passing.hpp"
#include "control/road/progress_reference.hpp"
#include "control/road/road_profile.hpp"
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
  static constexpr std::size_t kMostRows = 16;  // per step

  // `profile` must outlive the problem.
  TrackingProblem(const VehicleParameters& vehicle, const RoadProfile& profile,
                  const LpvAffineSettings& settings);

  // `s`: where the search for the vehicle's place on the road begins [m].
  void Begin(const State& z, double s, std::span<const Obstacle> obstacles);
  // False if a step needs more than kMostRows rows or there are more than PassingPlanner::kMostObstacles obstacles:
  // then no plan may be made.
  [[nodiscard]] bool BuildConstraints(std::span<const State> z_hat);
  // Forgets all decisions.
  void Reset();

  [[nodiscard]] const State& z() const { return z_; }  // as given to Begin, but ψ within π of the road's
  // True (almost) at standstill with nowhere to go; hysteresis keeps noise from ending it.
  [[nodiscard]] bool waiting() const { return waiting_; }
  // Fills in the plan of a waiting vehicle: the brake holds, the wheels stay as they are.
  void Hold(const Input& u_previous, std::span<State> z, std::span<Input> u) const;
  [[nodiscard]] std::span<const State> reference() const { return z_ref_; }
  [[nodiscard]] std::span<const Input> reference_input() const { return u_ref_; }
  // Rows of step i ≥ 1, valid until the next BuildConstraints.
  [[nodiscard]] std::span<const BodyRow> rows(std::size_t i) const { return {rows_[i].data(), counts_[i]}; }

 private:
  void Place(const State& z, double s);
  void DecidePassing();
  [[nodiscard]] bool Add(std::size_t i, const BodyRow& row);
  [[nodiscard]] bool AddRoad(std::size_t i, const State& z_hat, const RoutePoint& beside);
  [[nodiscard]] bool AddObstacles(std::size_t i, const State& z_hat, double psi_road);
  [[nodiscard]] std::optional<HalfSpace> Outside(const Obstacle& obstacle, Passage passage,
                                                 const State& z_hat, double psi_road) const;

  LpvAffineSettings settings_;
  const RoadProfile* profile_;
  ProgressReference progress_;
  PassingPlanner passing_;

  State z_ = State::Zero();
  double s_ = 0.0;        // arc length on the road [m]
  double lateral_ = 0.0;  // offset from the road, left positive [m]
  bool waiting_ = false;
  std::span<const Obstacle> obstacles_;
  std::span<const PassingDecision> decisions_;
  std::vector<StopLine> stops_;
  std::optional<std::size_t> first_stop_;  // index of the obstacle before which the vehicle stops
  std::vector<State> z_ref_;
  std::vector<Input> u_ref_;
  std::vector<double> s_ref_;
  std::vector<std::array<BodyRow, kMostRows>> rows_;
  std::vector<std::size_t> counts_;
};

}  // namespace control
