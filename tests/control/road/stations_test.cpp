#include "control/road/stations.hpp"

#include "gtest/gtest.h"
#include "tests/control/random.hpp"

namespace control {
namespace {

TEST(Stations, OnGridTheyAreAtTheSamePlacesOfTheRoadWhereverTheVehicleIs) {
  testing::Random random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    const double spacing = random.Uniform(1.0, 6.0), s_0 = random.Uniform(-50.0, 5000.0);
    const Stations stations = Stations::OnGrid(s_0, spacing);
    EXPECT_EQ(stations.At(0), s_0);
    EXPECT_GE(stations.Step(0), 0.5 * spacing - 1e-9);
    EXPECT_LT(stations.Step(0), 1.5 * spacing + 1e-9);
    for (std::size_t j = 1; j < kStations; ++j) {
      const double multiple = stations.At(j) / spacing;
      EXPECT_NEAR(multiple, std::round(multiple), 1e-9);
      EXPECT_NEAR(stations.At(j) - stations.At(j - 1), stations.Step(j - 1), 1e-9);
    }
    EXPECT_NEAR(stations.length(), stations.At(kStations - 1) - s_0, 1e-12);
  }
}

TEST(Stations, APlaceIsTheStationBeforeItAndAFraction) {
  testing::Random random(2);
  for (int trial = 0; trial < 1000; ++trial) {
    const Stations stations{.s_0 = random.Uniform(-50.0, 500.0),
                            .spacing = random.Uniform(1.0, 6.0),
                            .shift = random.Uniform(-0.5, 0.5)};
    const double s = stations.s_0 + random.Uniform(0.0, 1.0) * stations.length();
    const auto [j, fraction] = stations.PlaceOf(s);
    ASSERT_LT(j, kStations - 1);
    EXPECT_GE(fraction, 0.0);
    EXPECT_LE(fraction, 1.0);
    EXPECT_NEAR(stations.At(j) + fraction * stations.Step(j), s, 1e-9);
  }
}

TEST(Stations, PlacesBeyondTheEndsAreTakenToBeThere) {
  const Stations stations{.s_0 = 20.0, .spacing = 2.0, .shift = 0.5};
  EXPECT_EQ(stations.PlaceOf(12.0).j, 0u);
  EXPECT_EQ(stations.PlaceOf(12.0).fraction, 0.0);
  EXPECT_EQ(stations.PlaceOf(1e3).j, kStations - 1);
  EXPECT_EQ(stations.PlaceOf(1e3).fraction, 0.0);
}

}  // namespace
}  // namespace control
