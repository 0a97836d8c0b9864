// What came of a drive: measured each cycle on the vehicle's true state and on what the controller told, from
// its engagement on, and held against the scenario's expectations. Between two cycles nothing is measured: a point
// passes an obstacle's edge by less than what is seen, a footprint as long as a car by millimetres.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/scenario.hpp"
#include "sim/virtual_vehicle.hpp"

namespace sim {

// What a controller could not meet, as it told on the bus. On a real bus that may be heard in the cycle after.
struct UnmetConstraint {
  std::int64_t step = 0;  // of the drive, from 0
  bus::ConstraintReport report;
};

struct Summary {
  bool completed = false;    // driven by the controller to the end of the route or of the scenario's duration
  std::int64_t steps = 0;    // cycles from engagement on
  int infeasible_steps = 0;  // of those, cycles in mode Active whose solver status was not Solved
  int relaxed_steps = 0;     // cycles of which the plan gave way in a softened constraint
  int rejected_plans = 0;    // cycles of which the plan failed the check before it was followed
  std::optional<UnmetConstraint> first_unmet;
  std::optional<UnmetConstraint> worst_unmet;  // of the largest amount
  // Signed distance of the vehicle's footprint to the nearest obstacle's edge, negative in contact.
  std::optional<double> min_clearance_m;
  // Of the footprint's outermost corner to the nearer road edge, negative off the road.
  std::optional<double> min_road_margin_m;
  std::optional<std::int64_t> contact_step;   // the first at which the clearance was negative, from 0
  std::optional<std::int64_t> off_road_step;  // the first at which the road margin was negative
  bool standing = false;                      // the vehicle stood still at the end
  std::optional<double> rms_lateral_error_m;  // distance to the reference path
  int solve_time_median_us = 0;               // of the whole control step, as the controller told it
  int solve_time_p99_us = 0;
  int solve_time_max_us = 0;
  int deadline_misses = 0;

  std::vector<std::string> failed_expectations;  // one line each; empty: passed
  [[nodiscard]] bool passed() const { return failed_expectations.empty(); }
};

class Recorder {
 public:
  explicit Recorder(const Scenario& scenario) : scenario_(&scenario) {}  // which must outlive the recorder

  // Once a cycle, after the controller's frames and before VirtualVehicle::Advance().
  void Record(const VirtualVehicle& vehicle);

  // True at the end of the duration or of the route; and when nothing more is to come of the drive: the
  // vehicle stands, or takes more than twice the route's time.
  [[nodiscard]] bool finished() const { return finished_; }
  [[nodiscard]] double arc_length() const { return arc_length_; }  // place on the route [m]

  [[nodiscard]] Summary Result() const;

 private:
  void RecordStatus(const VirtualVehicle& vehicle);
  void RecordUnmet(const VirtualVehicle& vehicle);
  void RecordPlace(const VirtualVehicle& vehicle, double lateral);
  [[nodiscard]] std::optional<double> Clearance(const VirtualVehicle& vehicle) const;
  [[nodiscard]] double RoadMargin(const control::State& z) const;
  [[nodiscard]] bool EndReached(const VirtualVehicle& vehicle) const;

  const Scenario* scenario_;
  bool engaged_ = false;  // since some cycle
  bool finished_ = false;
  std::optional<double> hint_;
  double arc_length_ = 0.0;
  int standing_cycles_ = 0;
  double squared_lateral_ = 0.0;
  std::optional<std::uint16_t> last_misses_;
  std::vector<int> solve_times_us_;
  Summary summary_;
};

// One JSON object with the names above, the solve times as {"median", "p99", "max"} of solve_time_us, and
// `passed`; an unmet constraint as {"step", "verdict", "constraint", "index", "horizon_step", "amount"}.
[[nodiscard]] std::string ToJson(const Summary& summary);
// A few lines for a terminal.
[[nodiscard]] std::string ToText(const Summary& summary);

}  // namespace sim
