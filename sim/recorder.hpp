// Measures a drive's Summary: each cycle on the vehicle's true state, the true objects and the controller's frames.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "sim/end_of_route.hpp"
#include "sim/longest_run.hpp"
#include "sim/mode_changes.hpp"
#include "sim/rate_figures.hpp"
#include "sim/road_body.hpp"
#include "sim/scenario.hpp"
#include "sim/speed_excess.hpp"
#include "sim/summary.hpp"
#include "sim/surroundings.hpp"
#include "sim/virtual_vehicle.hpp"

namespace sim {

class Recorder {
 public:
  explicit Recorder(const Scenario& scenario);  // must outlive the recorder

  // Must be called once per cycle, after the controller's frames and before VirtualVehicle::Advance().
  void Record(const VirtualVehicle& vehicle);

  // True at the end of the duration or of the route, or if the state is not finite. Without a duration, also when the
  // vehicle stays at standstill and the controller does not drive, or 10 s after twice the route's time. If the scenario
  // expects a greatest overshoot or gap at the route's end, the drive goes on after that end until the vehicle stays at
  // standstill, for at most 10 s.
  [[nodiscard]] bool finished() const { return finished_; }
  [[nodiscard]] double arc_length() const { return arc_length_; }  // the vehicle's place on the route [m]

  [[nodiscard]] Summary Result() const;

 private:
  void RecordStatus(const VirtualVehicle& vehicle);
  void RecordUnmet(const VirtualVehicle& vehicle);
  void RecordRoad(const VirtualVehicle& vehicle, const control::RouteProjection& place);
  void RecordObjects(const VirtualVehicle& vehicle, const control::RouteProjection& place);
  void RecordContact(double speed, const RoadBody& vehicle, const std::optional<RoadBody>& object);
  void RecordMotion(const VirtualVehicle& vehicle, const control::RouteProjection& place);
  [[nodiscard]] double RoadMargin(const control::State& z) const;

  [[nodiscard]] bool AtEnd(const VirtualVehicle& vehicle) const;
  [[nodiscard]] bool IsTimeUp(const VirtualVehicle& vehicle) const;
  [[nodiscard]] bool DrivesOrHasArrived(const VirtualVehicle& vehicle) const;
  [[nodiscard]] bool IsDeadlocked() const;
  void Finish(const VirtualVehicle& vehicle);

  const Scenario* scenario_;
  Surroundings surroundings_;
  bool engaged_ = false;  // the controller was active in some cycle
  bool finished_ = false;
  std::optional<double> arrived_at_;  // time at which the vehicle was first at the route's end [s]
  std::optional<double> hint_;
  double arc_length_ = 0.0;
  int standing_cycles_ = 0;
  bool moved_ = false;  // since engagement
  double squared_lateral_ = 0.0;
  std::optional<std::uint16_t> last_misses_;
  std::vector<int> solve_times_us_;
  std::set<int> touching_;  // ids of the objects in contact
  SpeedExcess speed_excess_{kCycleTime};
  RateFigures steering_rate_{kCycleTime};
  RateFigures jerk_{kCycleTime};
  LongestRun free_standstill_{kCycleTime};
  EndOfRoute end_;
  ModeChanges modes_;
  Summary summary_;
};

}  // namespace sim
