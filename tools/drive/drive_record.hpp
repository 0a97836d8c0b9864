// A drive as the bus tells it: what report pages show, read from the frames of a log or of a drive in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "can/frame.hpp"
#include "control/vehicle/types.hpp"

namespace tools {

// One state set with the controller's answer to it.
struct DriveSample {
  std::int64_t cycle = 0;  // from 0; state sets that were lost leave gaps
  control::State z = control::State::Zero();
  control::Input u = control::Input::Zero();  // actuators, as measured
  bus::ControllerStatus status;               // none told: mode Init
  bus::SchedulingHealth health;
  std::vector<Eigen::Vector2d> plan;  // planned positions of steps 0..N; empty if no plan was told
};

struct DriveRecord {
  double t_s = 0.05;  // of a cycle [s]
  std::vector<DriveSample> samples;
  std::vector<control::Obstacle> obstacles;  // each as told first, its position moved back to cycle 0

  [[nodiscard]] double Time(const DriveSample& sample) const {
    return t_s * static_cast<double>(sample.cycle);
  }
  // From the vehicle to the obstacle's centre at that time [m].
  [[nodiscard]] double Distance(const DriveSample& sample, const control::Obstacle& obstacle) const;
};

// A record that fills less of a page: one sample in four, but all those near an obstacle and all whose problem was not
// solved. Plans stay near obstacles alone.
[[nodiscard]] DriveRecord Thinned(const DriveRecord& record);

// The greatest distance between where two plans that follow on each other see the vehicle at the same time [m]; 0 where
// there are no two.
[[nodiscard]] double LargestPlanChange(const DriveRecord& record);

// Index of the sample that was answered by control step `step`, counted from 0; the last one if there is none. The
// record must hold a sample.
[[nodiscard]] std::size_t SampleOfStep(const DriveRecord& record, int step);

// Samples from..to (indices) of it alone, as far as there are.
[[nodiscard]] DriveRecord Excerpt(const DriveRecord& record, std::size_t from, std::size_t to);

class DriveRecorder {
 public:
  // `bus` must outlive the recorder; its state sets come every `t_s` [s].
  DriveRecorder(const bus::VehicleBus& bus, double t_s) : bus_(&bus) { record_.t_s = t_s; }

  // A frame that is not of the bus, or fails its check, is passed over, and so is a state set that is repeated. Cycles
  // are counted by the counter of the state sets, and after a long silence by the time stamps.
  void Take(const can::Frame& frame);

  [[nodiscard]] const DriveRecord& record() const { return record_; }

 private:
  // Of the state set that is on its way.
  struct StatePart {
    std::optional<std::uint8_t> pose, motion, feedback;  // counters
  };
  struct LastSet {
    std::uint8_t counter;
    can::Time time;
  };

  void TakeMessage(const bus::Message& message, std::uint8_t counter, can::Time time);
  void AddSampleIfWhole(std::uint8_t counter, can::Time time);
  void TakeMotion(const bus::ObstacleMotion& motion);

  const bus::VehicleBus* bus_;
  DriveRecord record_;
  bus::VehiclePose pose_;
  bus::VehicleMotion motion_;
  bus::VehicleFeedback feedback_;
  StatePart part_;
  std::optional<LastSet> last_;
  std::vector<int> moving_told_;  // ids of the obstacles whose motion was told
  bool status_told_ = false;      // of the last sample; a later one answers the timer
  bool health_told_ = false;
  bool plan_wanted_ = false;  // the last header is of the last sample's plan
};

}  // namespace tools
