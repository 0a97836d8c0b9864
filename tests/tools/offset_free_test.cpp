// What a lasting disturbance leaves in closed loop over the bus, with the estimator and without.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "tools/drive/closed_loop.hpp"

namespace {

constexpr double kSpeed = 25.0;
constexpr double kDegree = std::numbers::pi / 180.0;

struct Errors {
  double lateral = 0.0;           // largest distance from the road's middle [m]
  double speed = 0.0;             // largest difference from the target speed [m/s]
  bus::DisturbanceEstimate told;  // the last report
};

// The errors between 5 s and 12 s on a straight road along X.
Errors Drive(const sim::PlantParameters& plant, bool offset_free) {
  const std::vector<control::RoutePiece> pieces{{.length = 500.0}};
  const config::RouteFile route{.route = control::Route::FromPieces({.X = 10.0}, kSpeed, pieces), .road = {}};
  sim::Scenario scenario(route.route, route.road);
  scenario.plant = plant;
  scenario.plant.tyre = sim::Tyre::kSaturating;
  scenario.steering.time_constant = 0.04;
  scenario.duration = 12.0;
  scenario.PlaceVehicle(0.0, kSpeed);
  loop::Config config;
  config.loop.offset_free = offset_free;
  const bus::VehicleBus bus;
  Errors errors;
  int cycles = 0;
  const sim::Summary summary = tools::DriveClosedLoop(
      scenario, config, route, {.frame = [&](const can::Frame& frame) {
        const auto message = bus.Decode(frame.id, frame.Payload());
        if (!message) return;
        if (std::holds_alternative<bus::VehiclePose>(*message)) ++cycles;
        if (cycles <= 100) return;
        if (const auto* pose = std::get_if<bus::VehiclePose>(&*message)) {
          errors.lateral = std::max(errors.lateral, std::abs(pose->Y));
        } else if (const auto* motion = std::get_if<bus::VehicleMotion>(&*message)) {
          errors.speed = std::max(errors.speed, std::abs(motion->upsilon - kSpeed));
        } else if (const auto* told = std::get_if<bus::DisturbanceEstimate>(&*message)) {
          errors.told = *told;
        }
      }});
  EXPECT_TRUE(summary.completed);
  EXPECT_GT(cycles, 200);
  return errors;
}

TEST(OffsetFree, DegreeOfSteeringOffsetLeavesThreeCentimetres) {
  for (const double offset : {kDegree, -kDegree}) {
    EXPECT_LT(Drive({.steering_offset = offset}, true).lateral, 0.03);
    EXPECT_GT(Drive({.steering_offset = offset}, false).lateral, 0.3);
  }
}

TEST(OffsetFree, BankOfATenthLeavesTwoCentimetres) {
  const double bank = std::atan(0.1);
  EXPECT_LT(Drive({.bank = bank}, true).lateral, 0.02);
  EXPECT_GT(Drive({.bank = bank}, false).lateral, 0.05);
}

TEST(OffsetFree, SlopeLeavesTheSpeed) {
  const double slope = std::atan(0.05);
  EXPECT_LT(Drive({.slope = slope}, true).speed, 0.05);
  EXPECT_GT(Drive({.slope = slope}, false).speed, 0.2);
}

TEST(OffsetFree, EstimateIsToldOnTheBus) {
  const bus::DisturbanceEstimate told = Drive({.steering_offset = kDegree, .slope = 0.03}, true).told;
  EXPECT_NEAR(told.steering_offset, kDegree, 0.05 * kDegree);
  EXPECT_NEAR(told.longitudinal_acceleration, -0.03 * control::kGravity, 0.02);
  EXPECT_NEAR(told.grip, loop::Config().affine.mu, 5e-4);  // the resolution
  const bus::DisturbanceEstimate none = Drive({.steering_offset = kDegree}, false).told;
  EXPECT_EQ(none.steering_offset, 0.0);
  EXPECT_EQ(none.stiffness_factor, 1.0);
}

// The estimate may be in error where the model is; then it must not do harm.
TEST(OffsetFree, UndisturbedVehicleStaysInTheMiddle) {
  EXPECT_LT(Drive({}, true).lateral, 2e-3);
}

}  // namespace
