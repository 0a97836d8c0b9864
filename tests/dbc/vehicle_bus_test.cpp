#include "dbc/vehicle_bus.hpp"

#include <gtest/gtest.h>

namespace {

TEST(VehicleBus, BuiltInDbcBindsAndAMessageComesBack) {
  const dbc::VehicleBus bus;
  dbc::RawMessage raw;
  ASSERT_EQ(bus.Encode(dbc::VehiclePose{.X = 12.0, .Y = -3.5}, 7, raw), dbc::EncodeStatus::kOk);
  const dbc::E2eCheck check = bus.Check(raw.id, raw.Payload());
  EXPECT_EQ(check.verdict, dbc::E2eVerdict::kOk);
  EXPECT_EQ(check.counter, 7);
  const auto back = bus.Decode(raw.id, raw.Payload());
  ASSERT_TRUE(back);
  EXPECT_NEAR(std::get<dbc::VehiclePose>(*back).X, 12.0, 1e-9);
  EXPECT_NEAR(std::get<dbc::VehiclePose>(*back).Y, -3.5, 1e-9);
}

}  // namespace
