// The result of a drive: measured each cycle on the vehicle's true state and on the controller's reports, from its
// engagement on, and compared with the scenario's expectations. Nothing is measured between two cycles, so the true
// clearance can be smaller than the recorded one; for a footprint as long as a car, by millimetres.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/messages.hpp"
#include "sim/encounter_figures.hpp"
#include "sim/scenario.hpp"

namespace sim {

// A constraint that the controller reported as unmet. On a real bus the report may arrive one cycle later.
struct UnmetConstraint {
  std::int64_t step = 0;  // step of the drive, counted from 0
  bus::ConstraintReport report;
};

struct Summary {
  // The controller drove to the end of the route or of the scenario's duration; not if it stands in a deadlock when the
  // duration ends: for more than 5 s although the way is free (sim/free_way.hpp), or without having ever moved.
  bool completed = false;
  bool time_is_up = false;   // the duration ended before the route did, more than 1 m before its end
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
  std::optional<ContactFault> contact_fault;  // ours if at least one contact is
  std::optional<std::int64_t> off_road_step;  // the first step with a negative road margin
  bool standing = false;                      // the vehicle was at standstill at the end
  std::optional<double> rms_lateral_error_m;  // distance to the reference path
  int solve_time_median_us = 0;               // time of the whole control step, as reported by the controller
  int solve_time_p99_us = 0;
  int solve_time_max_us = 0;
  int deadline_misses = 0;
  std::optional<double>
      max_speed_excess_mps;  // greatest true speed over the route's target there (speed_excess.hpp)
  // Of the commands received, from one cycle to the next, while they are to be obeyed.
  std::optional<double> rms_steering_rate;  // [rad/s]
  std::optional<double> p99_steering_rate;
  std::optional<double> rms_jerk;  // [m/s³]
  std::optional<double> p99_jerk;
  // The longest time for which the vehicle stood although the way was free, more than 1 m before the route's end.
  double longest_free_standstill_s = 0.0;
  // How far the centre of gravity got past the route's end; negative: how far short of it it was at the end of the drive;
  // none if it was never within the last 5 m. A drive ends at the route's end, at the first sample past it, unless the
  // scenario expects a greatest overshoot or gap.
  std::optional<double> end_overshoot_m;
  int mode_changes = 0;  // after engagement, without those that end the drive at the route's end
  int safe_stops = 0;    // those into SafeStop
  std::optional<double>
      min_time_to_collision_s;  // with an object ahead in the vehicle's way (encounter_figures.hpp)

  std::vector<std::string> failed_expectations;  // one line each; empty: passed
  [[nodiscard]] bool passed() const { return failed_expectations.empty(); }
};

// One of the scenario's expectations, compared with what was measured.
struct JudgedExpectation {
  std::string figure;
  std::string measured;
  std::string expected;  // "at most 0.5"
  std::string fault;     // in a line; "" if the expectation is met

  [[nodiscard]] bool met() const { return fault.empty(); }
};
[[nodiscard]] std::vector<JudgedExpectation> JudgeExpectations(const Summary& summary,
                                                               const Expectations& expect);
// One line for each of the scenario's expectations that the summary does not meet.
[[nodiscard]] std::vector<std::string> FailedExpectations(const Summary& summary, const Expectations& expect);

// Returns one JSON object with the names above and `passed`. The solve times are {"median", "p99", "max"} of
// solve_time_us; an unmet constraint is {"step", "verdict", "constraint", "index", "horizon_step", "amount"};
// contact_fault is "ours", "theirs" or null.
[[nodiscard]] std::string ToJson(const Summary& summary);
// Returns a few lines for a terminal.
[[nodiscard]] std::string ToText(const Summary& summary);

}  // namespace sim
