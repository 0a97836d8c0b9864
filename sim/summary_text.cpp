#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bus/names.hpp"
#include "sim/summary.hpp"

namespace sim {
namespace {

template <typename T>
nlohmann::json OrNull(const std::optional<T>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

std::string OrDash(const std::optional<double>& value, const char* unit = "m") {
  return value ? fmt::format("{:.3f} {}", *value, unit) : "-";
}

const char* NameOf(ContactFault fault) {
  return fault == ContactFault::kOurs ? "ours" : "theirs";
}

nlohmann::json FaultJson(const std::optional<ContactFault>& fault) {
  return fault ? nlohmann::json(NameOf(*fault)) : nlohmann::json(nullptr);
}

nlohmann::ordered_json UnmetJson(const std::optional<UnmetConstraint>& unmet) {
  if (!unmet) return nullptr;
  const bus::ConstraintReport& report = unmet->report;
  return {{"step", unmet->step},
          {"verdict", bus::Name(report.verdict)},
          {"constraint", bus::Name(report.constraint)},
          {"index", report.index},
          {"horizon_step", report.step},
          {"amount", report.amount}};
}

std::string UnmetText(const UnmetConstraint& unmet) {
  const bus::ConstraintReport& report = unmet.report;
  return fmt::format("step {}: {} {} at i = {}, by {:.3f} ({})", unmet.step, bus::Name(report.constraint),
                     report.index, report.step, report.amount, bus::Name(report.verdict));
}

}  // namespace

std::string ToJson(const Summary& summary) {
  const nlohmann::ordered_json json{
      {"completed", summary.completed},
      {"time_is_up", summary.time_is_up},
      {"steps", summary.steps},
      {"infeasible_steps", summary.infeasible_steps},
      {"relaxed_steps", summary.relaxed_steps},
      {"rejected_plans", summary.rejected_plans},
      {"first_unmet", UnmetJson(summary.first_unmet)},
      {"worst_unmet", UnmetJson(summary.worst_unmet)},
      {"min_clearance_m", OrNull(summary.min_clearance_m)},
      {"min_road_margin_m", OrNull(summary.min_road_margin_m)},
      {"contact_step", OrNull(summary.contact_step)},
      {"contact_fault", FaultJson(summary.contact_fault)},
      {"off_road_step", OrNull(summary.off_road_step)},
      {"standing", summary.standing},
      {"rms_lateral_error_m", OrNull(summary.rms_lateral_error_m)},
      {"solve_time_us",
       {{"median", summary.solve_time_median_us},
        {"p99", summary.solve_time_p99_us},
        {"max", summary.solve_time_max_us}}},
      {"deadline_misses", summary.deadline_misses},
      {"max_speed_excess_mps", OrNull(summary.max_speed_excess_mps)},
      {"rms_steering_rate", OrNull(summary.rms_steering_rate)},
      {"p99_steering_rate", OrNull(summary.p99_steering_rate)},
      {"rms_jerk", OrNull(summary.rms_jerk)},
      {"p99_jerk", OrNull(summary.p99_jerk)},
      {"longest_free_standstill_s", summary.longest_free_standstill_s},
      {"end_overshoot_m", OrNull(summary.end_overshoot_m)},
      {"mode_changes", summary.mode_changes},
      {"safe_stops", summary.safe_stops},
      {"min_time_to_collision_s", OrNull(summary.min_time_to_collision_s)},
      {"passed", summary.passed()},
      {"failed_expectations", summary.failed_expectations},
  };
  return json.dump(2) + "\n";
}

std::string ToText(const Summary& summary) {
  std::string text;
  const auto line = [&text](const char* name, const std::string& value) {
    text += fmt::format("{:<27}{}\n", name, value);
  };
  line("completed", summary.completed ? "yes" : "no");
  if (summary.time_is_up) line("time is up", "before the route's end");
  line("steps", std::to_string(summary.steps));
  line("infeasible steps", std::to_string(summary.infeasible_steps));
  line("relaxed steps", std::to_string(summary.relaxed_steps));
  line("rejected plans", std::to_string(summary.rejected_plans));
  if (summary.first_unmet) line("first unmet", UnmetText(*summary.first_unmet));
  if (summary.worst_unmet) line("worst unmet", UnmetText(*summary.worst_unmet));
  line("smallest clearance", OrDash(summary.min_clearance_m));
  if (summary.contact_step && summary.contact_fault)
    line("contact", fmt::format("step {}, {}", *summary.contact_step, NameOf(*summary.contact_fault)));
  line("smallest road margin", OrDash(summary.min_road_margin_m));
  line("RMS lateral error", OrDash(summary.rms_lateral_error_m));
  line("solve time", fmt::format("{} us median, {} us p99, {} us max", summary.solve_time_median_us,
                                 summary.solve_time_p99_us, summary.solve_time_max_us));
  line("deadline misses", std::to_string(summary.deadline_misses));
  line("greatest speed excess", OrDash(summary.max_speed_excess_mps, "m/s"));
  const auto rate = [&line](const char* name, const auto& rms, const auto& p99, const char* unit) {
    line(name, rms && p99 ? fmt::format("{:.3f} {} RMS, {:.3f} {} p99", *rms, unit, *p99, unit) : "-");
  };
  rate("steering rate", summary.rms_steering_rate, summary.p99_steering_rate, "rad/s");
  rate("jerk", summary.rms_jerk, summary.p99_jerk, "m/s^3");
  line("longest free standstill", fmt::format("{:.2f} s", summary.longest_free_standstill_s));
  line("end overshoot", OrDash(summary.end_overshoot_m));
  line("mode changes", fmt::format("{}, {} into SafeStop", summary.mode_changes, summary.safe_stops));
  line("smallest time to collision", OrDash(summary.min_time_to_collision_s, "s"));
  line("result", summary.passed()
                     ? "passed"
                     : "FAILED: " + fmt::format("{}", fmt::join(summary.failed_expectations, "; ")));
  return text;
}

}  // namespace sim
