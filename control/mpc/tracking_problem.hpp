// What is asked of the vehicle in one control step, whoever solves it: the reference from the vehicle's place on, on which
// side each obstacle is passed or where to stop, and the rows that hold the vehicle's rectangle on the road and out of
// obstacles. It keeps what has to last from step to step: the place on the course and the decisions.
//
//   task.Begin(z, obstacles);       // once a step
//   task.BuildConstraints(z_hat);   // about a predicted trajectory, as often as there is a new one
//   for (const BodyRow& row : task.rows(i)) …
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

// lo ≤ normalᵀ p ≤ hi for the point p of the map where the point `fixed` of the vehicle's body is.
struct BodyRow {
  Eigen::Vector2d normal;
  Eigen::Vector2d fixed;
  double lo = 0.0;
  double hi = 0.0;
  Constraint constraint;
};

class TrackingProblem {
 public:
  static constexpr std::size_t kMostRows = 16;  // of a step

  // `course` must outlive it.
  TrackingProblem(const VehicleParameters& vehicle, const RoadProfile& course,
                  const LpvAffineSettings& settings);

  void Begin(const State& z, std::span<const Obstacle> obstacles);
  // False if a step has more rows than there is room for, or there are more obstacles than can be decided about: then no
  // plan may be made.
  [[nodiscard]] bool BuildConstraints(std::span<const State> z_hat);
  // The vehicle may be anywhere, and nothing is decided.
  void Reset();

  [[nodiscard]] const State& z() const { return z_; }  // of Begin, ψ within π of the course's
  // At standstill, or almost, with nowhere to go to. It takes more than noise to go on.
  [[nodiscard]] bool waiting() const { return waiting_; }
  // The plan of a vehicle that waits: the brake holds, the wheels stay as they are.
  void Hold(const Input& u_previous, std::span<State> z, std::span<Input> u) const;
  [[nodiscard]] std::span<const State> reference() const { return z_ref_; }
  [[nodiscard]] std::span<const Input> reference_input() const { return u_ref_; }
  // Of step i ≥ 1; they belong to the task until the next BuildConstraints.
  [[nodiscard]] std::span<const BodyRow> rows(std::size_t i) const { return {rows_[i].data(), counts_[i]}; }

 private:
  void Place(const State& z);
  void DecidePassing();
  [[nodiscard]] bool Add(std::size_t i, const BodyRow& row);
  [[nodiscard]] bool AddRoad(std::size_t i, const State& z_hat, const RoutePoint& beside);
  [[nodiscard]] bool AddObstacles(std::size_t i, const State& z_hat, double psi_road);
  [[nodiscard]] std::optional<HalfSpace> Outside(const Obstacle& obstacle, Passage passage,
                                                 const State& z_hat, double psi_road) const;

  LpvAffineSettings settings_;
  const RoadProfile* course_;
  ProgressReference progress_;
  PassingPlanner passing_;

  State z_ = State::Zero();
  double s_ = 0.0;        // place on the course [m]
  double lateral_ = 0.0;  // and beside it, left positive [m]
  bool placed_ = false;   // since the last Reset
  bool waiting_ = false;
  std::span<const Obstacle> obstacles_;
  std::span<const PassingDecision> decisions_;
  std::vector<StopLine> stops_;
  std::optional<std::size_t> first_stop_;  // index of the obstacle that it stops for
  std::vector<State> z_ref_;
  std::vector<Input> u_ref_;
  std::vector<double> s_ref_;
  std::vector<std::array<BodyRow, kMostRows>> rows_;
  std::vector<std::size_t> counts_;
};

}  // namespace control
