#include <cstddef>
#include <gtest/gtest.h>
#include <limits>

#include "dbc/vehicle_bus.hpp"
#include "tests/support/allocations.hpp"

namespace {

using test_support::Allocations;

TEST(VehicleBus, EncodeCheckAndDecodeDoNotAllocate) {
  const std::size_t at_start = Allocations();
  const dbc::VehicleBus bus;
  ASSERT_GT(Allocations(), at_start) << "the counter of allocations does not count";

  const dbc::Message messages[] = {
      dbc::VehiclePose{.X = 1.0},
      dbc::VehicleMotion{},
      dbc::VehicleFeedback{},
      dbc::ObstaclePosition{},
      dbc::ObstacleShape{},
      dbc::ObstacleMotion{},
      dbc::ObstacleList{},
      dbc::DriverRequest{},
      dbc::SteeringCommand{.delta = 1e9},
      dbc::AccelerationCommand{.acceleration = std::numeric_limits<double>::infinity()},
      dbc::ControllerStatus{},
      dbc::SchedulingHealth{},
      dbc::HorizonHeader{},
      dbc::HorizonPoint{}};
  const std::size_t before = Allocations();
  long decoded = 0;
  for (const dbc::Message& message : messages) {
    dbc::RawMessage raw;
    if (bus.Encode(message, 3, raw) == dbc::EncodeStatus::kNotFinite) continue;
    if (bus.Check(raw.id, raw.Payload()).verdict != dbc::E2eVerdict::kOk) continue;
    if (!bus.InRange(raw.id, raw.Payload())) continue;
    if (bus.Decode(raw.id, raw.Payload())) ++decoded;
  }
  const std::size_t after = Allocations();
  EXPECT_EQ(after, before);
  EXPECT_EQ(decoded, 13);
}

}  // namespace
