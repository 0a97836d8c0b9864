#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <limits>
#include <new>
#include <string>

#include "dbc/vehicle_bus.hpp"

namespace {
std::atomic<long> allocations{0};
}

// Not inlined: the compiler would see malloc and free there where it expects new and delete.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace {

TEST(VehicleBus, EncodeCheckAndDecodeDoNotAllocate) {
  const long at_start = allocations;
  const dbc::VehicleBus bus;
  ASSERT_GT(allocations, at_start) << "the counter of allocations does not count";

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
  const long before = allocations;
  long decoded = 0;
  for (const dbc::Message& message : messages) {
    dbc::RawMessage raw;
    if (bus.Encode(message, 3, raw) == dbc::EncodeStatus::kNotFinite) continue;
    if (bus.Check(raw.id, raw.Payload()).verdict != dbc::E2eVerdict::kOk) continue;
    if (bus.Decode(raw.id, raw.Payload())) ++decoded;
  }
  const long after = allocations;
  EXPECT_EQ(after, before);
  EXPECT_EQ(decoded, 13);
}

}  // namespace
