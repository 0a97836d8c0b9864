#include <cstddef>
#include <gtest/gtest.h>
#include <limits>

#include "bus/vehicle_bus.hpp"
#include "tests/support/allocations.hpp"

namespace bus {
namespace {

using test_support::Allocations;

TEST(VehicleBus, EncodeCheckAndDecodeDoNotAllocate) {
  const std::size_t at_start = Allocations();
  const VehicleBus bus;
  ASSERT_GT(Allocations(), at_start) << "the counter of allocations does not count";

  const Message messages[] = {VehiclePose{.X = 1.0},
                              VehicleMotion{},
                              VehicleFeedback{},
                              ObstaclePosition{},
                              ObstacleShape{},
                              ObstacleMotion{},
                              ObstacleList{},
                              DriverRequest{},
                              SteeringCommand{.delta = 1e9},
                              AccelerationCommand{.acceleration = std::numeric_limits<double>::infinity()},
                              ControllerStatus{},
                              SchedulingHealth{},
                              HorizonHeader{},
                              HorizonPoint{}};
  const std::size_t before = Allocations();
  long decoded = 0;
  for (const Message& message : messages) {
    RawMessage raw;
    if (bus.Encode(message, 3, raw) == dbc::EncodeStatus::kNotFinite) continue;
    if (bus.Check(raw.id, raw.Payload()).verdict != E2eVerdict::kOk) continue;
    if (!bus.InRange(raw.id, raw.Payload())) continue;
    if (bus.Decode(raw.id, raw.Payload())) ++decoded;
  }
  const std::size_t after = Allocations();
  EXPECT_EQ(after, before);
  EXPECT_EQ(decoded, 13);
}

}  // namespace
}  // namespace bus
