#include <fmt/format.h>

#include "sim/summary.hpp"

namespace sim {
namespace {

std::string Number(int value) {
  return fmt::format("{}", value);
}
std::string Number(double value) {
  return fmt::format("{:.4g}", value);
}

class ExpectationCheck {
 public:
  template <typename T>
  void AtMost(const char* figure, const T& value, const std::optional<T>& limit) {
    if (!limit) return;
    Add({.figure = figure,
         .measured = Number(value),
         .expected = fmt::format("at most {}", *limit),
         .fault = value > *limit ? fmt::format("{} = {} is above {}", figure, value, *limit) : ""});
  }
  // A figure without a value, such as the clearance without obstacles, is as expected.
  void AtLeast(const char* figure, const std::optional<double>& value, const std::optional<double>& limit) {
    if (!limit) return;
    Add({.figure = figure,
         .measured = value ? Number(*value) : "none",
         .expected = fmt::format("at least {}", *limit),
         .fault =
             value && *value < *limit ? fmt::format("{} = {:.4f} is below {}", figure, *value, *limit) : ""});
  }
  void Add(JudgedExpectation expectation) { judged_.push_back(std::move(expectation)); }

  [[nodiscard]] std::vector<JudgedExpectation> Take() { return std::move(judged_); }

 private:
  std::vector<JudgedExpectation> judged_;
};

}  // namespace

std::vector<JudgedExpectation> JudgeExpectations(const Summary& summary, const Expectations& expect) {
  ExpectationCheck check;
  check.Add({.figure = "completed",
             .measured = fmt::format("{}", summary.completed),
             .expected = fmt::format("{}", expect.completed),
             .fault = summary.completed != expect.completed ? fmt::format("completed = {}", summary.completed)
                                                            : ""});
  check.AtMost("infeasible_steps", summary.infeasible_steps, expect.max_infeasible_steps);
  check.AtLeast("min_clearance_m", summary.min_clearance_m, expect.min_clearance_m);
  check.AtLeast("min_road_margin_m", summary.min_road_margin_m, expect.min_road_margin_m);
  check.AtMost("rms_lateral_error_m", summary.rms_lateral_error_m.value_or(0.0),
               expect.max_rms_lateral_error_m);
  check.AtMost("deadline_misses", summary.deadline_misses, expect.max_deadline_misses);
  check.AtMost("max_speed_excess_mps", summary.max_speed_excess_mps.value_or(0.0),
               expect.max_speed_excess_mps);
  check.AtMost("rms_steering_rate", summary.rms_steering_rate.value_or(0.0), expect.max_rms_steering_rate);
  check.AtMost("p99_steering_rate", summary.p99_steering_rate.value_or(0.0), expect.max_p99_steering_rate);
  check.AtMost("rms_jerk", summary.rms_jerk.value_or(0.0), expect.max_rms_jerk);
  check.AtMost("p99_jerk", summary.p99_jerk.value_or(0.0), expect.max_p99_jerk);
  check.AtMost("longest_free_standstill_s", summary.longest_free_standstill_s, expect.max_free_standstill_s);
  check.AtMost("end_overshoot_m", summary.end_overshoot_m.value_or(0.0), expect.max_end_overshoot_m);
  if (expect.max_end_gap_m && !summary.end_overshoot_m) {
    check.Add({.figure = "end_overshoot_m",
               .measured = "none",
               .expected = "any",
               .fault = "end_overshoot_m: the end was not reached"});
  }
  check.AtMost("gap before the end", -summary.end_overshoot_m.value_or(0.0), expect.max_end_gap_m);
  check.AtMost("mode_changes", summary.mode_changes, expect.max_mode_changes);
  check.AtMost("safe_stops", summary.safe_stops, expect.max_safe_stops);
  check.AtLeast("min_time_to_collision_s", summary.min_time_to_collision_s, expect.min_time_to_collision_s);
  return check.Take();
}

std::vector<std::string> FailedExpectations(const Summary& summary, const Expectations& expect) {
  std::vector<std::string> failed;
  for (const JudgedExpectation& expectation : JudgeExpectations(summary, expect)) {
    if (!expectation.met()) failed.push_back(expectation.fault);
  }
  return failed;
}

}  // namespace sim
