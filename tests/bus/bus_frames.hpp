// Frames as a vehicle sends them, for tests.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "can/frame.hpp"
#include "dbc/e2e.hpp"

namespace bus {

inline can::Frame MakeFrame(const bus::VehicleBus& bus, const bus::Message& message, std::uint8_t counter) {
  bus::RawMessage raw;
  if (bus.Encode(message, counter, raw) == dbc::EncodeStatus::kNotFinite) {
    throw std::runtime_error("value not finite");
  }
  can::Frame frame{.id = raw.id, .length = raw.length};
  std::ranges::copy(raw.Payload(), frame.data.begin());
  return frame;
}

// A scripted vehicle with its driver and its perception: the next frames carry the values of the members.
class FakeVehicle {
 public:
  explicit FakeVehicle(const bus::VehicleBus& bus) : bus_(&bus) {}

  bus::VehiclePose pose;
  bus::VehicleMotion motion{.upsilon = 10.0};
  bus::VehicleFeedback feedback;
  bus::DriverRequest request;
  std::vector<bus::ObstaclePosition> obstacles;

  std::vector<can::Frame> Request() { return {MakeFrame(*bus_, request, Next(request_counter_))}; }
  std::vector<can::Frame> Obstacles() {
    std::vector<can::Frame> frames;
    for (const bus::ObstaclePosition& o : obstacles) {
      const bus::ObstacleShape shape{.object_id = o.object_id, .semi_axis_x = 1.0, .semi_axis_y = 1.0};
      frames.push_back(MakeFrame(*bus_, o, Next(object_counter_)));
      frames.push_back(MakeFrame(*bus_, shape, Next(object_counter_)));
      frames.push_back(
          MakeFrame(*bus_, bus::ObstacleMotion{.object_id = o.object_id}, Next(object_counter_)));
    }
    const bus::ObstacleList list{.count = static_cast<std::uint8_t>(obstacles.size())};
    frames.push_back(MakeFrame(*bus_, list, Next(list_counter_)));
    return frames;
  }
  std::vector<can::Frame> State() {
    const std::uint8_t counter = Next(state_counter_);
    return {MakeFrame(*bus_, pose, counter), MakeFrame(*bus_, motion, counter),
            MakeFrame(*bus_, feedback, counter)};
  }
  // Request, obstacles, state: all that a vehicle sends in one period.
  std::vector<can::Frame> All() {
    std::vector<can::Frame> frames = Request();
    for (const auto& part : {Obstacles(), State()}) {
      frames.insert(frames.end(), part.begin(), part.end());
    }
    return frames;
  }
  [[nodiscard]] std::uint8_t last_state_counter() const {
    return static_cast<std::uint8_t>((state_counter_ + dbc::kCounterModulus - 1) % dbc::kCounterModulus);
  }
  // Leaves out one state set; its counter value is skipped.
  void SkipState() { Next(state_counter_); }

 private:
  static std::uint8_t Next(std::uint8_t& counter) {
    const std::uint8_t now = counter;
    counter = dbc::NextCounter(counter);
    return now;
  }

  const bus::VehicleBus* bus_;
  std::uint8_t state_counter_ = 0;
  std::uint8_t request_counter_ = 0;
  std::uint8_t object_counter_ = 0;
  std::uint8_t list_counter_ = 0;
};

}  // namespace bus
