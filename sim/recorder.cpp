#include "sim/recorder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/percentile.hpp"
#include "sim/footprint_distance.hpp"
#include "sim/free_way.hpp"

namespace sim {
namespace {

constexpr double kStandstillSpeed = 0.05;  // [m/s]
constexpr int kStandstillCycles = 40;      // at rest for good, not just in passing
constexpr double kDeadlock = 5.0;          // standing for longer, though the way is free [s]
constexpr double kAtEnd = 1.0;             // within it of the route's end, nothing is left to drive [m]
constexpr double kAfterEnd = 10.0;         // longest time in which the end's overshoot is watched [s]
constexpr int kMissesModulus = 1024;       // modulus of ControllerStatus::deadline_misses

void KeepSmaller(std::optional<double>& smallest, double value) {
  smallest = std::min(smallest.value_or(value), value);
}

double SpeedOf(const VirtualVehicle& vehicle) {
  return vehicle.state().segment<2>(control::kUpsilon).norm();
}

}  // namespace

Recorder::Recorder(const Scenario& scenario) : scenario_(&scenario), surroundings_(scenario.route) {}

void Recorder::RecordStatus(const VirtualVehicle& vehicle) {
  if (!vehicle.status_is_new()) return;
  const bus::ControllerStatus& status = vehicle.status();
  modes_.Take(status.mode, status.fault_code);
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

double Recorder::RoadMargin(const control::State& z) const {
  const Eigen::Rotation2Dd turn(z[control::kPsi]);
  double margin = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& corner : scenario_->footprint.Corners()) {
    const Eigen::Vector2d place = z.segment<2>(control::kX) + turn * corner;
    const auto [s, lateral] = scenario_->route.Project(place, hint_);
    const control::RoadBounds road = scenario_->road.At(s);
    margin = std::min({margin, road.left - lateral, lateral - road.right});
  }
  return margin;
}

void Recorder::RecordRoad(const VirtualVehicle& vehicle, const control::RouteProjection& place) {
  const double margin = RoadMargin(vehicle.state());
  KeepSmaller(summary_.min_road_margin_m, margin);
  if (margin < 0.0 && !summary_.off_road_step) summary_.off_road_step = summary_.steps - 1;
  squared_lateral_ += place.lateral * place.lateral;
}

void Recorder::RecordContact(double speed, const RoadBody& vehicle, const std::optional<RoadBody>& object) {
  if (!summary_.contact_step) summary_.contact_step = summary_.steps - 1;
  const ContactFault fault = object ? FaultOf(speed, vehicle, *object) : ContactFault::kOurs;
  if (summary_.contact_fault != ContactFault::kOurs) summary_.contact_fault = fault;
}

void Recorder::RecordObjects(const VirtualVehicle& vehicle, const control::RouteProjection& place) {
  const control::State& z = vehicle.state();
  const double speed = SpeedOf(vehicle);
  const RoadBody body = VehicleOnRoad(z, scenario_->footprint, scenario_->route, place);
  const std::vector<control::Obstacle> objects = vehicle.ObstaclesNow();
  const std::vector<std::optional<RoadBody>> on_road = surroundings_.OnRoad(objects, place.s);
  std::vector<RoadBody> near;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const double clearance = FootprintDistance(objects[i], scenario_->footprint,
                                               {z[control::kX], z[control::kY]}, z[control::kPsi]);
    KeepSmaller(summary_.min_clearance_m, clearance);
    if (clearance >= 0.0) {
      touching_.erase(objects[i].id);
    } else if (touching_.insert(objects[i].id).second) {
      RecordContact(speed, body, on_road[i]);
    }
    if (!on_road[i]) continue;
    near.push_back(*on_road[i]);
    if (const auto time = TimeToCollision(body, *on_road[i]))
      KeepSmaller(summary_.min_time_to_collision_s, *time);
  }
  const bool stands = speed < kStandstillSpeed && scenario_->route.length() - place.s > kAtEnd;
  free_standstill_.Take(
      stands && WayIsFree(body, scenario_->footprint, scenario_->plant.vehicle.l_r, near, scenario_->road));
}

void Recorder::RecordMotion(const VirtualVehicle& vehicle, const control::RouteProjection& place) {
  const double speed = SpeedOf(vehicle);
  moved_ = moved_ || speed >= kStandstillSpeed;
  speed_excess_.Take(speed, scenario_->route.At(place.s).speed);
  end_.Take(scenario_->route.length() - place.s);
  const std::optional<control::Input> commands = vehicle.commands();
  const auto command = [&](control::InputIndex i) {
    return commands ? std::optional<double>((*commands)[i]) : std::nullopt;
  };
  steering_rate_.Take(command(control::kDelta));
  jerk_.Take(command(control::kAcceleration));
}

bool Recorder::AtEnd(const VirtualVehicle& vehicle) const {
  const bool reported = engaged_ && vehicle.status().fault_code == bus::FaultCode::kRouteEnd;
  return reported || arc_length_ >= scenario_->route.length();
}

bool Recorder::IsTimeUp(const VirtualVehicle& vehicle) const {
  return scenario_->duration && vehicle.time() + kCycleTime >= *scenario_->duration - 1e-9;
}

bool Recorder::DrivesOrHasArrived(const VirtualVehicle& vehicle) const {
  return engaged_ && (Drives(vehicle.mode()) || vehicle.status().fault_code == bus::FaultCode::kRouteEnd);
}

bool Recorder::IsDeadlocked() const {
  return free_standstill_.present() > kDeadlock || (standing_cycles_ > 0 && !moved_);
}

void Recorder::Finish(const VirtualVehicle& vehicle) {
  if (!arrived_at_ && AtEnd(vehicle)) {
    arrived_at_ = vehicle.time();
    summary_.completed = DrivesOrHasArrived(vehicle);
  }
  const bool stands = standing_cycles_ >= kStandstillCycles;
  if (arrived_at_) {
    const bool watched = scenario_->expect.max_end_overshoot_m || scenario_->expect.max_end_gap_m;
    finished_ = !watched || stands || IsTimeUp(vehicle) || vehicle.time() >= *arrived_at_ + kAfterEnd - 1e-9;
  } else if (IsTimeUp(vehicle)) {
    finished_ = true;
    summary_.completed = DrivesOrHasArrived(vehicle) && !IsDeadlocked();
    summary_.time_is_up = scenario_->route.length() - arc_length_ > kAtEnd;
  } else if (!scenario_->duration) {
    finished_ =
        (stands && !Drives(vehicle.mode())) || vehicle.time() > 2.0 * scenario_->route.duration() + 10.0;
  }
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
    RecordRoad(vehicle, place);
    RecordObjects(vehicle, place);
    RecordMotion(vehicle, place);
  }
  standing_cycles_ = SpeedOf(vehicle) < kStandstillSpeed ? standing_cycles_ + 1 : 0;
  Finish(vehicle);
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
  summary.max_speed_excess_mps = speed_excess_.Greatest();
  summary.rms_steering_rate = steering_rate_.Rms();
  summary.p99_steering_rate = steering_rate_.P99();
  summary.rms_jerk = jerk_.Rms();
  summary.p99_jerk = jerk_.P99();
  summary.longest_free_standstill_s = free_standstill_.longest();
  summary.end_overshoot_m = end_.Overshoot();
  summary.mode_changes = modes_.changes();
  summary.safe_stops = modes_.safe_stops();
  summary.failed_expectations = FailedExpectations(summary, scenario_->expect);
  return summary;
}

}  // namespace sim
