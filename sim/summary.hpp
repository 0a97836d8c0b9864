// The result of a drive: measured each cycle on the vehicle's true state and on the controller's reports, from its
// engagement on, and compared with the scenario's expectations. Nothing is measured between two cycles, so the true
// clearance can be smaller than the recorded one; for a footprint as long as a car, by millimetres.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/scenario.hpp"
#include "sim/virtual_vehicle.hpp"

namespace sim {

// A constraint that the controller reported as unmet. On a real bus the report may arrive one cycle later.
struct UnmetConstraint {
  std::int64_t step = 0;  // step of the drive, counted from 0
  bus::ConstraintReport report;
};

struct Summary {
  bool completed = false;    // the controller drove to the end of the route or of the scenario's duration
  std::int64_t steps = 0;    // cycles from engagement on
  int infeasible_steps = 0;  // those in mode Active or Degraded with a status other than Solved
  int relaxed_steps = 0;     // cycles whose plan relaxed a soft constraint
  int rejected_plans = 0;    // cycles whose plan failed the check before it was followed
  std::optional<UnmetConstraint> first_unmet;
  std::optional<UnmetConstraint> worst_unmet;  // that with the largest amount
  // Signed distance from the vehicle's footprint to the nearest obstacle's edge, negative in contact.
  std::optional<double> min_clearance_m;
  // Signed distance from the footprint's outermost corner to the nearer road edge, negative off the road.
  std::optional<double> min_road_margin_m;
  std::optional<std::int64_t> contact_step;   // the first step with negative clearance, from 0
  std::optional<std::int64_t> off_road_step;  // the first step with a negative road margin
  bool standing = false;                      // the vehicle was at standstill at the end
  std::optional<double> rms_lateral_error_m;  // distance to the reference path
  int solve_time_median_us = 0;               // time of the whole control step, as reported by the controller
  int solve_time_p99_us = 0;
  int solve_time_max_us = 0;
  int deadline_misses = 0;

  std::vector<std::string> failed_expectations;  // one line each; empty: passed
  [[nodiscard]] bool passed() const { return failed_expectations.empty(); }
};

class Recorder {
 public:
  explicit Recorder(const Scenario& scenario) : scenario_(&scenario) {}  // must outlive the recorder

  // Must be called once per cycle, after the controller's frames and before VirtualVehicle::Advance().
  void Record(const VirtualVehicle& vehicle);

  // True at the end of the duration or of the route, or if the state is not finite. Without a duration, also when the
  // vehicle stays at standstill and the controller does not drive, or 10 s after twice the route's time.
  [[nodiscard]] bool finished() const { return finished_; }
  [[nodiscard]] double arc_length() const { return arc_length_; }  // the vehicle's place on the route [m]

  [[nodiscard]] Summary Result() const;

 private:
  void RecordStatus(const VirtualVehicle& vehicle);
  void RecordUnmet(const VirtualVehicle& vehicle);
  void RecordPlace(const VirtualVehicle& vehicle, double lateral);
  [[nodiscard]] std::optional<double> Clearance(const VirtualVehicle& vehicle) const;
  [[nodiscard]] double RoadMargin(const control::State& z) const;
  [[nodiscard]] bool EndReached(const VirtualVehicle& vehicle) const;

  const Scenario* scenario_;
  bool engaged_ = false;  // the controller was active in some cycle
  bool finished_ = false;
  std::optional<double> hint_;
  double arc_length_ = 0.0;
  int standing_cycles_ = 0;
  double squared_lateral_ = 0.0;
  std::optional<std::uint16_t> last_misses_;
  std::vector<int> solve_times_us_;
  Summary summary_;
};

// Returns one JSON object with the names above and `passed`. The solve times are {"median", "p99", "max"} of
// solve_time_us; an unmet constraint is {"step", "verdict", "constraint", "index", "horizon_step", "amount"}.
[[nodiscard]] std::string ToJson(const Summary& summary);
// Returns a few lines for a terminal.
[[nodiscard]] std::string ToText(const Summary& summary);

}  // namespace sim
