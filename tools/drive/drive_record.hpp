// A drive as recorded on the bus, for report pages: decoded from the frames of a log or of a drive in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "bus/decision_change.hpp"
#include "bus/vehicle_bus.hpp"
#include "can/frame.hpp"
#include "control/vehicle/types.hpp"

namespace tools {

// One state set with the controller's answer to it.
struct DriveSample {
  std::int64_t cycle = 0;  // counted from 0; lost state sets leave gaps
  control::State z = control::State::Zero();
  control::Input u = control::Input::Zero();  // measured δ [rad] and a [m/s²]
  bus::ControllerStatus status;               // mode Init if none was received
  bus::SchedulingHealth health;
  bus::ManoeuvreStatus manoeuvre;
  std::vector<Eigen::Vector2d> plan;  // planned positions of steps 0..N [m]; empty if no plan was received
};

// An object as the perception reported it, before one state set after the other.
struct RecordedObject {
  struct Place {
    std::int64_t cycle = 0;  // of the state set
    double X = 0.0;
    double Y = 0.0;
    double heading = 0.0;
  };

  control::Obstacle first;    // as first reported
  std::vector<Place> places;  // in the order of their cycles; at least one

  // Whether it had been reported by this cycle and still was later, or in it.
  [[nodiscard]] bool ExistsAt(std::int64_t cycle) const {
    return places.front().cycle <= cycle && cycle <= places.back().cycle;
  }
  // Where it was last reported by this cycle; before it was, where it was first.
  [[nodiscard]] const Place& At(std::int64_t cycle) const;
};

// A decision of the controller that differs from the one before, and held (bus/decision_change.hpp).
struct RecordedDecision {
  std::int64_t cycle = 0;  // from which on it was taken
  bus::ManoeuvreStatus manoeuvre;
};

struct DriveRecord {
  double t_s = 0.05;  // duration of a cycle [s]
  std::vector<DriveSample> samples;
  std::vector<RecordedObject> objects;  // by the order of their first reports
  std::vector<RecordedDecision> decisions;

  [[nodiscard]] double Time(std::int64_t cycle) const { return t_s * static_cast<double>(cycle); }
  [[nodiscard]] double Time(const DriveSample& sample) const { return Time(sample.cycle); }
};

// Distance from the vehicle to the object's centre when the sample was taken [m].
[[nodiscard]] double Distance(const DriveSample& sample, const RecordedObject& object);

// A smaller record for a page: one sample in four, plus all within 25 m of an object and all whose problem was not
// solved. Plans are kept only near objects.
[[nodiscard]] DriveRecord Thinned(const DriveRecord& record);

// A still smaller record: one sample in `one_in`, plus all whose problem was not solved. Only one sample in four of them
// keeps its plan.
[[nodiscard]] DriveRecord Coarse(const DriveRecord& record, std::size_t one_in);

// The greatest distance between the positions that the plans of two consecutive cycles predict for the same time [m]; 0
// if there are no such plans.
[[nodiscard]] double LargestPlanChange(const DriveRecord& record);

// Index of the sample that control step `step`, counted from 0, answered; the last sample if there is none. The record
// must not be empty.
[[nodiscard]] std::size_t SampleOfStep(const DriveRecord& record, int step);

// Only the samples with indices from..to, as far as they exist.
[[nodiscard]] DriveRecord Excerpt(const DriveRecord& record, std::size_t from, std::size_t to);

class DriveRecorder {
 public:
  // `bus` must outlive the recorder; it carries a state set every `t_s` [s].
  DriveRecorder(const bus::VehicleBus& bus, double t_s) : bus_(&bus) { record_.t_s = t_s; }

  // Ignores frames that are not of the bus or fail their check, and repeated state sets. Cycles are counted by the
  // counter of the state sets, and after a long silence by the time stamps.
  void Take(const can::Frame& frame);

  [[nodiscard]] const DriveRecord& record() const { return record_; }

 private:
  // The counters of the messages received so far of an incomplete state set.
  struct StatePart {
    std::optional<std::uint8_t> pose, motion, feedback;
  };
  struct LastSet {
    std::uint8_t counter;
    can::Time time;
  };

  void TakeMessage(const bus::Message& message, std::uint8_t counter, can::Time time);
  void AddSampleIfWhole(std::uint8_t counter, can::Time time);
  // The object with this id among those reported since the last state set.
  [[nodiscard]] control::Obstacle& Reported(int id);
  void TakeManoeuvre(const bus::ManoeuvreStatus& manoeuvre, DriveSample& sample);
  void PlaceObjects(std::int64_t cycle);

  const bus::VehicleBus* bus_;
  DriveRecord record_;
  bus::VehiclePose pose_;
  bus::VehicleMotion motion_;
  bus::VehicleFeedback feedback_;
  StatePart part_;
  std::optional<LastSet> last_;
  std::vector<control::Obstacle> reported_;  // since the last state set
  bus::DecisionChange decision_;
  bool status_received_ = false;  // for the last sample; a later status answers the timer
  bool health_received_ = false;
  bool manoeuvre_received_ = false;
  bool plan_wanted_ = false;  // the last header belongs to the last sample's plan
};

}  // namespace tools
