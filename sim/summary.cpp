#include "sim/summary.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/percentile.hpp"
#include "bus/names.hpp"
#include "sim/footprint_distance.hpp"

namespace sim {
namespace {

constexpr double kStandstillSpeed = 0.05;  // [m/s]
constexpr int kStandstillCycles = 40;      // at rest for good, not just in passing
constexpr int kMissesModulus = 1024;       // modulus of ControllerStatus::deadline_misses

void KeepSmaller(std::optional<double>& smallest, double value) {
  smallest = std::min(smallest.value_or(value), value);
}

class ExpectationCheck {
 public:
  explicit ExpectationCheck(std::vector<std::string>& failed) : failed_(&failed) {}

  template <typename T>
  void AtMost(const char* name, const T& value, const std::optional<T>& limit) {
    if (limit && value > *limit) failed_->push_back(fmt::format("{} = {} is above {}", name, value, *limit));
  }
  void AtLeast(const char* name, const std::optional<double>& value, const std::optional<double>& limit) {
    if (limit && value && *value < *limit)
      failed_->push_back(fmt::format("{} = {:.4f} is below {}", name, *value, *limit));
  }

 private:
  std::vector<std::string>* failed_;
};

template <typename T>
nlohmann::json OrNull(const std::optional<T>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

std::string OrDash(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f} m", *value) : "-";
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

void Recorder::RecordStatus(const VirtualVehicle& vehicle) {
  if (!vehicle.status_is_new()) return;
  const bus::ControllerStatus& status = vehicle.status();
  if (Drives(status.mode)) {
    if (status.solver_status != bus::SolverStatus::kSolved) ++summary_.infeasible_steps;
    solve_times_us_.push_back(static_cast<int>(std::lround(status.solve_time * 1e6)));
  }
  if (last_misses_) {
    summary_.deadline_misses += (status.deadline_misses - *last_misses_ + kMissesModulus) % kMissesModulus;
  }
  last_misses_ = status.deadline_misses;
}

void Recorder::RecordUnmet(const VirtualVehicle& vehicle) {
  const auto& unmet = vehicle.unmet();
  if (!unmet) return;
  if (unmet->verdict == bus::ConstraintVerdict::kRelaxed) ++summary_.relaxed_steps;
  if (unmet->verdict == bus::ConstraintVerdict::kRejected) ++summary_.rejected_plans;
  const UnmetConstraint now{.step = summary_.steps - 1, .report = *unmet};
  if (!summary_.first_unmet) summary_.first_unmet = now;
  if (!summary_.worst_unmet || unmet->amount > summary_.worst_unmet->report.amount)
    summary_.worst_unmet = now;
}

std::optional<double> Recorder::Clearance(const VirtualVehicle& vehicle) const {
  const control::State& z = vehicle.state();
  std::optional<double> clearance;
  for (const control::Obstacle& obstacle : vehicle.ObstaclesNow()) {
    KeepSmaller(clearance, FootprintDistance(obstacle, scenario_->footprint, {z[control::kX], z[control::kY]},
                                             z[control::kPsi]));
  }
  return clearance;
}

double Recorder::RoadMargin(const control::State& z) const {
  const Eigen::Rotation2Dd turn(z[control::kPsi]);
  double margin = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& corner : scenario_->footprint.Corners()) {
    const Eigen::Vector2d place = z.segment<2>(control::kX) + turn * corner;
    const double lateral = scenario_->route.Project(place, hint_).lateral;
    margin = std::min({margin, scenario_->road.left - lateral, lateral - scenario_->road.right});
  }
  return margin;
}

void Recorder::RecordPlace(const VirtualVehicle& vehicle, double lateral) {
  const std::int64_t step = summary_.steps - 1;
  if (const auto clearance = Clearance(vehicle)) {
    KeepSmaller(summary_.min_clearance_m, *clearance);
    if (*clearance < 0.0 && !summary_.contact_step) summary_.contact_step = step;
  }
  const double margin = RoadMargin(vehicle.state());
  KeepSmaller(summary_.min_road_margin_m, margin);
  if (margin < 0.0 && !summary_.off_road_step) summary_.off_road_step = step;
  squared_lateral_ += lateral * lateral;
}

bool Recorder::EndReached(const VirtualVehicle& vehicle) const {
  const bool route_end_reported = engaged_ && vehicle.status().fault_code == bus::FaultCode::kRouteEnd;
  return route_end_reported || arc_length_ >= scenario_->route.length() ||
         (scenario_->duration && vehicle.time() + kCycleTime >= *scenario_->duration - 1e-9);
}

void Recorder::Record(const VirtualVehicle& vehicle) {
  const control::State& z = vehicle.state();
  if (!z.allFinite()) {
    finished_ = true;
    return;
  }
  const control::RouteProjection place = scenario_->route.Project({z[control::kX], z[control::kY]}, hint_);
  hint_ = arc_length_ = place.s;
  engaged_ = engaged_ || vehicle.mode() == bus::Mode::kActive;
  if (engaged_) {
    ++summary_.steps;
    RecordStatus(vehicle);
    RecordUnmet(vehicle);
    RecordPlace(vehicle, place.lateral);
  }
  standing_cycles_ = z.segment<2>(control::kUpsilon).norm() < kStandstillSpeed ? standing_cycles_ + 1 : 0;

  if (EndReached(vehicle)) {
    finished_ = true;
    summary_.completed =
        engaged_ && (Drives(vehicle.mode()) || vehicle.status().fault_code == bus::FaultCode::kRouteEnd);
  } else if (!scenario_->duration) {
    const bool stands = standing_cycles_ >= kStandstillCycles && !Drives(vehicle.mode());
    finished_ = stands || vehicle.time() > 2.0 * scenario_->route.duration() + 10.0;
  }
}

Summary Recorder::Result() const {
  Summary summary = summary_;
  summary.standing = standing_cycles_ >= kStandstillCycles;
  if (summary.steps > 0) {
    summary.rms_lateral_error_m = std::sqrt(squared_lateral_ / static_cast<double>(summary.steps));
  }
  std::vector<int> sorted = solve_times_us_;
  std::ranges::sort(sorted);
  summary.solve_time_median_us = base::Percentile(sorted, 0.5);
  summary.solve_time_p99_us = base::Percentile(sorted, 0.99);
  summary.solve_time_max_us = base::Percentile(sorted, 1.0);

  const Expectations& expect = scenario_->expect;
  if (summary.completed != expect.completed) {
    summary.failed_expectations.push_back(fmt::format("completed = {}", summary.completed));
  }
  ExpectationCheck check(summary.failed_expectations);
  check.AtMost("infeasible_steps", summary.infeasible_steps, expect.max_infeasible_steps);
  check.AtLeast("min_clearance_m", summary.min_clearance_m, expect.min_clearance_m);
  check.AtLeast("min_road_margin_m", summary.min_road_margin_m, expect.min_road_margin_m);
  check.AtMost("rms_lateral_error_m", summary.rms_lateral_error_m.value_or(0.0),
               expect.max_rms_lateral_error_m);
  check.AtMost("deadline_misses", summary.deadline_misses, expect.max_deadline_misses);
  return summary;
}

std::string ToJson(const Summary& summary) {
  const nlohmann::ordered_json json{
      {"completed", summary.completed},
      {"steps", summary.steps},
      {"infeasible_steps", summary.infeasible_steps},
      {"relaxed_steps", summary.relaxed_steps},
      {"rejected_plans", summary.rejected_plans},
      {"first_unmet", UnmetJson(summary.first_unmet)},
      {"worst_unmet", UnmetJson(summary.worst_unmet)},
      {"min_clearance_m", OrNull(summary.min_clearance_m)},
      {"min_road_margin_m", OrNull(summary.min_road_margin_m)},
      {"contact_step", OrNull(summary.contact_step)},
      {"off_road_step", OrNull(summary.off_road_step)},
      {"standing", summary.standing},
      {"rms_lateral_error_m", OrNull(summary.rms_lateral_error_m)},
      {"solve_time_us",
       {{"median", summary.solve_time_median_us},
        {"p99", summary.solve_time_p99_us},
        {"max", summary.solve_time_max_us}}},
      {"deadline_misses", summary.deadline_misses},
      {"passed", summary.passed()},
      {"failed_expectations", summary.failed_expectations},
  };
  return json.dump(2) + "\n";
}

std::string ToText(const Summary& summary) {
  std::string text;
  const auto line = [&text](const char* name, const std::string& value) {
    text += fmt::format("{:<22}{}\n", name, value);
  };
  line("completed", summary.completed ? "yes" : "no");
  line("steps", std::to_string(summary.steps));
  line("infeasible steps", std::to_string(summary.infeasible_steps));
  line("relaxed steps", std::to_string(summary.relaxed_steps));
  line("rejected plans", std::to_string(summary.rejected_plans));
  if (summary.first_unmet) line("first unmet", UnmetText(*summary.first_unmet));
  if (summary.worst_unmet) line("worst unmet", UnmetText(*summary.worst_unmet));
  line("smallest clearance", OrDash(summary.min_clearance_m));
  line("smallest road margin", OrDash(summary.min_road_margin_m));
  line("RMS lateral error", OrDash(summary.rms_lateral_error_m));
  line("solve time", fmt::format("{} us median, {} us p99, {} us max", summary.solve_time_median_us,
                                 summary.solve_time_p99_us, summary.solve_time_max_us));
  line("deadline misses", std::to_string(summary.deadline_misses));
  line("result", summary.passed()
                     ? "passed"
                     : "FAILED: " + fmt::format("{}", fmt::join(summary.failed_expectations, "; ")));
  return text;
}

}  // namespace sim
