#include "sim/virtual_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "dbc/e2e.hpp"

namespace sim {
namespace {

bus::PassingSide OnBus(control::PassingSide side) {
  switch (side) {
    case control::PassingSide::kLeft:
      return bus::PassingSide::kLeft;
    case control::PassingSide::kRight:
      return bus::PassingSide::kRight;
    case control::PassingSide::kUnknown:
      break;
  }
  return bus::PassingSide::kUnknown;
}

bus::Outline OnBus(control::ObstacleShape shape) {
  return shape == control::ObstacleShape::kBox ? bus::Outline::kBox : bus::Outline::kEllipse;
}

bus::ObstacleClass OnBus(control::ObstacleClass object_class) {
  switch (object_class) {
    case control::ObstacleClass::kStatic:
      return bus::ObstacleClass::kStatic;
    case control::ObstacleClass::kVehicle:
      return bus::ObstacleClass::kVehicle;
    case control::ObstacleClass::kCycle:
      return bus::ObstacleClass::kCycle;
    case control::ObstacleClass::kPedestrian:
      return bus::ObstacleClass::kPedestrian;
    case control::ObstacleClass::kUnknown:
      break;
  }
  return bus::ObstacleClass::kUnknown;
}

}  // namespace

VirtualVehicle::VirtualVehicle(const Scenario& scenario, const bus::VehicleBus& bus)
    : bus_(&bus),
      plant_(scenario.plant, scenario.initial),
      steering_actuator_(scenario.steering, scenario.initial_delta),
      acceleration_actuator_(scenario.acceleration, 0.0),
      sensors_(scenario.sensors, scenario.seed),
      driver_(scenario.driver),
      traffic_(scenario) {
  frames_.reserve(5 + 3 * scenario.obstacles.size());
}

std::uint8_t VirtualVehicle::StateCounter() const {
  return static_cast<std::uint8_t>(cycle_ % dbc::kCounterModulus);
}

void VirtualVehicle::Emit(const bus::Message& message, std::uint8_t counter, can::Time now) {
  bus::RawMessage raw;
  if (bus_->Encode(message, counter, raw) == dbc::EncodeStatus::kNotFinite) return;
  can::Frame frame{.id = raw.id, .length = raw.length, .timestamp = now};
  std::ranges::copy(raw.data, frame.data.begin());
  frames_.push_back(frame);
}

std::vector<control::Obstacle> VirtualVehicle::PerceivedNow() const {
  std::vector<control::Obstacle> perceived = ObstaclesNow();
  std::erase_if(perceived, [this](const control::Obstacle& o) { return !traffic_.IsPerceived(o.id); });
  return perceived;
}

void VirtualVehicle::EmitObstacles(can::Time now) {
  const auto emit = [&](const bus::Message& message) {
    Emit(message, object_counter_, now);
    object_counter_ = dbc::NextCounter(object_counter_);
  };
  std::vector<control::Obstacle> perceived = PerceivedNow();
  perceived.insert(perceived.end(), ghosts_.begin(), ghosts_.end());
  for (const control::Obstacle& obstacle : perceived) {
    const auto id = static_cast<std::uint8_t>(obstacle.id);
    emit(bus::ObstaclePosition{.object_id = id, .X = obstacle.X, .Y = obstacle.Y});
    emit(bus::ObstacleShape{.object_id = id,
                            .semi_axis_x = obstacle.r_x,
                            .semi_axis_y = obstacle.r_y,
                            .heading = obstacle.heading,
                            .passing_side = OnBus(obstacle.side),
                            .outline = OnBus(obstacle.shape)});
    emit(bus::ObstacleMotion{.object_id = id,
                             .velocity_X = obstacle.velocity_X,
                             .velocity_Y = obstacle.velocity_Y,
                             .object_class = OnBus(obstacle.object_class)});
  }
  Emit(bus::ObstacleList{.count = static_cast<std::uint8_t>(perceived.size())}, list_counter_, now);
  list_counter_ = dbc::NextCounter(list_counter_);
}

std::span<const can::Frame> VirtualVehicle::Sense(can::Time now) {
  frames_.clear();
  Emit(driver_.Request(time(), mode()), request_counter_, now);
  request_counter_ = dbc::NextCounter(request_counter_);
  EmitObstacles(now);

  const control::State z = sensors_.Measure(plant_.state());
  Emit(bus::VehiclePose{.X = z[control::kX], .Y = z[control::kY]}, StateCounter(), now);
  Emit(
      bus::VehicleMotion{.upsilon = z[control::kUpsilon], .nu = z[control::kNu], .omega = z[control::kOmega]},
      StateCounter(), now);
  Emit(bus::VehicleFeedback{.psi = control::WrapAngle(z[control::kPsi]),
                            .delta = steering_actuator_.value(),
                            .acceleration = acceleration_actuator_.value()},
       StateCounter(), now);
  return frames_;
}

template <typename Command>
void VirtualVehicle::Take(const Command& command, double value, Channel& channel) const {
  channel.enable = command.enable;
  channel.value = value;
  channel.age = 0;
  channel.answered = channel.answered || command.state_counter == StateCounter();
}

void VirtualVehicle::Receive(const can::Frame& frame) {
  if (frame.kind != can::FrameKind::kData || frame.extended || frame.fd) return;
  if (bus_->Find(frame.id) == nullptr) return;
  if (bus_->Check(frame.id, frame.Payload()).verdict != bus::E2eVerdict::kOk) {
    ++rejected_frames_;
    return;
  }
  const std::optional<bus::Message> message = bus_->Decode(frame.id, frame.Payload());
  if (!message) {
    ++rejected_frames_;
  } else if (const auto* steering = std::get_if<bus::SteeringCommand>(&*message)) {
    Take(*steering, steering->delta, steering_);
  } else if (const auto* acceleration = std::get_if<bus::AccelerationCommand>(&*message)) {
    Take(*acceleration, acceleration->acceleration, acceleration_);
  } else if (const auto* status = std::get_if<bus::ControllerStatus>(&*message)) {
    status_ = *status;
    status_is_new_ = true;
    status_after_ = steering_.answered && acceleration_.answered;
    heard_ = true;
  } else if (const auto* report = std::get_if<bus::ConstraintReport>(&*message)) {
    if (report->verdict != bus::ConstraintVerdict::kMet) unmet_ = *report;
  }
}

void VirtualVehicle::Apply(const Channel& channel, double by_driver, Actuator& actuator) {
  if (channel.Obeyed()) {
    actuator.Command(channel.value);
  } else {
    actuator.Override(by_driver);
  }
}

void VirtualVehicle::Advance() {
  if (obeyed_ && (steering_.age > 0 || acceleration_.age > 0)) ++missed_commands_;
  obeyed_ = obeyed_ || (steering_.Obeyed() && acceleration_.Obeyed());
  Apply(steering_, steering_actuator_.value(), steering_actuator_);
  Apply(acceleration_, obeyed_ ? kDriverDeceleration : 0.0, acceleration_actuator_);

  const control::State before = plant_.state();
  const auto steps = std::lround(kCycleTime / kIntegrationStep);
  for (long i = 0; i < steps; ++i) {
    const control::Input start = actuators();
    steering_actuator_.Advance(0.5 * kIntegrationStep);
    acceleration_actuator_.Advance(0.5 * kIntegrationStep);
    const control::Input middle = actuators();
    steering_actuator_.Advance(0.5 * kIntegrationStep);
    acceleration_actuator_.Advance(0.5 * kIntegrationStep);
    plant_.Step(start, middle, actuators(), kIntegrationStep);
  }
  ++cycle_;
  traffic_.Advance(time(), before);
  for (Channel* channel : {&steering_, &acceleration_}) {
    channel->age = std::min(channel->age + 1, kCommandLifetime);
    channel->answered = false;
  }
  status_after_ = false;
  status_is_new_ = false;
  unmet_.reset();
}

std::optional<control::Input> VirtualVehicle::commands() const {
  if (!steering_.Obeyed() || !acceleration_.Obeyed()) return std::nullopt;
  return control::Input(steering_.value, acceleration_.value);
}

}  // namespace sim
