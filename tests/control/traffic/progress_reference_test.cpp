#include "control/traffic/progress_reference.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "control/vehicle/blended_model.hpp"
#include "gtest/gtest.h"
#include "tests/control/roads.hpp"

namespace control {
namespace {

constexpr double kTs = 0.05;

// The reference of one cycle, `seconds` long.
struct Filled {
  std::vector<State> z;
  std::vector<Input> u;
  std::vector<double> s;

  Filled(const RoadProfile& profile, double s_0, double upsilon, std::span<const StopLine> stops,
         double seconds = 2.0, const Disturbance& disturbance = {})
      : z(static_cast<std::size_t>(std::lround(seconds / kTs)) + 1), u(z.size() - 1), s(z.size()) {
    Manoeuvre manoeuvre;
    std::ranges::copy(stops, manoeuvre.stop_lines.begin());
    manoeuvre.stop_count = stops.size();
    ProgressReference({}, profile, kTs, 100.0).Fill(s_0, upsilon, manoeuvre, z, u, s, disturbance);
  }
};

TEST(ProgressReference, UnderADisturbanceItsStatesAreSteadyTooAndRunAlongTheRoad) {
  const Disturbance disturbance{.delta_0 = 0.02, .a_y = 0.8, .a_x = -0.5, .stiffness_factor = 0.7};
  const BlendedModel model(VehicleParameters{}, disturbance);
  for (const double speed : {8.5, 12.0, 20.0}) {
    const double radius = speed * speed / 3.0;
    const RoadProfile profile(testing::CircularRoad(radius, 1.0, speed), {}, {.lateral = 4.0});
    const Filled reference(profile, 1.0, speed, {}, 0.5, disturbance);
    for (std::size_t i = 0; i < reference.u.size(); ++i) {
      const State& z = reference.z[i];
      const State derivative = model.Derivative(z, reference.u[i]);
      EXPECT_NEAR(derivative[kUpsilon], z[kOmega] * z[kNu], 1e-9);
      // The remainder is due to cos δ.
      EXPECT_LT(std::abs(derivative[kNu]), 0.05) << speed;
      EXPECT_LT(std::abs(derivative[kOmega]), 0.03) << speed;
      EXPECT_NEAR(z[kPsi] + z[kNu] / z[kUpsilon], profile.At(reference.s[i]).psi, 1e-12);
    }
  }
}

TEST(ProgressReference, SlowsDownComfortablyIfAskedTo) {
  const RoadProfile profile(testing::StraightRoad(400.0, 12.0), {}, {});
  std::vector<State> z(161);
  std::vector<Input> u(160);
  std::vector<double> s(161);
  const Manoeuvre manoeuvre;
  ProgressReference({}, profile, kTs, 100.0).Fill(50.0, 12.0, manoeuvre, z, u, s, {}, true);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double t = static_cast<double>(i) * kTs;
    EXPECT_NEAR(z[i][kUpsilon], std::max(12.0 - profile.limits().deceleration * t, 0.0), 1e-6);
  }
}

TEST(ProgressReference, OnABendItsStatesAreThoseOfSteadyCornering) {
  const BlendedModel model{VehicleParameters{}};
  for (const double speed : {8.5, 12.0, 20.0}) {
    const double radius = speed * speed / 3.0;
    const RoadProfile profile(testing::CircularRoad(radius, 1.0, speed), {}, {.lateral = 4.0});
    const Filled reference(profile, 1.0, speed, {}, 0.5);
    for (std::size_t i = 0; i < reference.u.size(); ++i) {
      const State& z = reference.z[i];
      const State derivative = model.Derivative(z, reference.u[i]);
      // The lateral acceleration is 3 m/s²; the remainder is due to cos δ.
      EXPECT_LT(std::abs(derivative[kNu]), 0.03) << speed;
      EXPECT_LT(std::abs(derivative[kOmega]), 0.03) << speed;
      const RoutePoint point = profile.At(reference.s[i]);
      EXPECT_NEAR(std::atan2(derivative[kY], derivative[kX]), WrapAngle(point.psi), 2e-3) << speed;
      EXPECT_EQ(z[kX], point.X);
      EXPECT_EQ(z[kY], point.Y);
      EXPECT_NEAR(derivative[kPsi], speed / radius, 1e-6);
      EXPECT_NEAR(reference.u[i][kAcceleration], 0.0, 1e-9);
    }
  }
}

TEST(ProgressReference, BeginsWhereTheVehicleIsAtAboutItsSpeedAndComesToTheProfilesGently) {
  const SpeedLimits limits{.lateral = 3.0, .acceleration = 1.2, .deceleration = 2.0};
  const RoadProfile profile(testing::StraightRoad(300.0, 12.0), {}, limits);
  for (const double s_0 : {-5.0, 0.0, 100.0}) {
    for (const double upsilon : {-0.2, 0.0, 4.0, 11.0, 16.0}) {
      const Filled reference(profile, s_0, upsilon, {}, 6.0);
      EXPECT_EQ(reference.s[0], s_0);
      EXPECT_NEAR(reference.z[0][kUpsilon], std::max(upsilon, 0.0), 0.5 + 1e-12);
      for (std::size_t i = 0; i < reference.u.size(); ++i) {
        const double speed = reference.z[i][kUpsilon], next = reference.z[i + 1][kUpsilon];
        EXPECT_GE(speed, 0.0);
        EXPECT_NEAR(next - speed, kTs * reference.u[i][kAcceleration], 1e-12);
        EXPECT_NEAR(reference.s[i + 1] - reference.s[i], 0.5 * kTs * (speed + next), 1e-12);
        EXPECT_LE(reference.u[i][kAcceleration], limits.acceleration + 1e-9);
        EXPECT_GE(reference.u[i][kAcceleration], -1.5 * limits.deceleration - 1e-9);
      }
      if (upsilon >= 11.0) {
        EXPECT_NEAR(reference.z.back()[kUpsilon], 12.0, 1e-9);
      }
      EXPECT_GT(reference.z.back()[kUpsilon], 5.0);
    }
  }
}

TEST(ProgressReference, NoiseOfTheSpeedIsNoAcceleration) {
  const RoadProfile profile(testing::StraightRoad(300.0, 12.0), {}, {});
  for (const double noise : {-0.45, -0.1, 0.2, 0.45}) {
    for (const Input& u : Filled(profile, 50.0, 12.0 + noise, {}).u)
      EXPECT_EQ(u[kAcceleration], 0.0) << noise;
  }
  EXPECT_GT(Filled(profile, 50.0, 11.0, {}).u[0][kAcceleration], 0.5);
  EXPECT_LT(Filled(profile, 50.0, 13.0, {}).u[0][kAcceleration], -0.5);
}

TEST(ProgressReference, FromStandstillItSetsOff) {
  const RoadProfile profile(testing::StraightRoad(300.0, 12.0), {}, {});
  const Filled reference(profile, 0.0, 0.0, {});
  EXPECT_NEAR(reference.u[0][kAcceleration], profile.limits().acceleration, 1e-9);
  EXPECT_GT(reference.s.back(), 2.5);
}

TEST(ProgressReference, StopsBeforeTheFirstOfTheLines) {
  const RoadProfile profile(testing::StraightRoad(300.0, 12.0), {}, {});
  const std::vector<StopLine> stops{{.s = 120.0}, {.s = 80.0}};
  const Filled reference(profile, 30.0, 12.0, stops, 20.0);
  EXPECT_EQ(reference.z.back()[kUpsilon], 0.0);
  EXPECT_LE(reference.s.back(), 80.0);
  EXPECT_GT(reference.s.back(), 80.0 - 2.0 * RoadProfile::kStopWithin);
  EXPECT_EQ(Filled(profile, 80.1, 0.0, stops).s.back(), 80.1) << "past the line it does not go on";
}

TEST(ProgressReference, BehindALineThatMovesItGoesOnAtItsSpeed) {
  const RoadProfile profile(testing::StraightRoad(500.0, 12.0), {}, {});
  const StopLine line{.s = 60.0, .speed = 5.0};
  const Filled reference(profile, 30.0, 12.0, {&line, 1}, 20.0);
  for (std::size_t i = 0; i < reference.s.size(); ++i) {
    EXPECT_LE(reference.s[i], line.s + line.speed * kTs * static_cast<double>(i));
  }
  EXPECT_NEAR(reference.z.back()[kUpsilon], line.speed, 0.3);
}

TEST(ProgressReference, BeyondALineThatMovesItFallsBack) {
  const RoadProfile profile(testing::StraightRoad(500.0, 12.0), {}, {});
  const StopLine line{.s = 60.0, .speed = 5.0};
  const Filled reference(profile, 61.0, 5.0, {&line, 1}, 20.0);
  EXPECT_LT(reference.z[0][kUpsilon], line.speed);
  EXPECT_NEAR(reference.s.back(), line.s + line.speed * 20.0, 0.1);
  const StopLine standing{.s = 60.0};
  EXPECT_EQ(Filled(profile, 61.0, 0.0, {&standing, 1}, 2.0).s.back(), 61.0);
}

TEST(ProgressReference, StopsAtTheEndOfTheCourseAndStaysThere) {
  const RoadProfile profile(testing::StraightRoad(60.0, 10.0), {}, {});
  const Filled reference(profile, 20.0, 10.0, {}, 15.0);
  EXPECT_EQ(reference.z.back()[kUpsilon], 0.0);
  EXPECT_LE(reference.s.back(), 60.0 + 0.01);
  EXPECT_GT(reference.s.back(), 60.0 - 2.0 * RoadProfile::kStopWithin);
  EXPECT_EQ(Filled(profile, 61.0, 0.0, {}).s.back(), 61.0);
}

}  // namespace
}  // namespace control
