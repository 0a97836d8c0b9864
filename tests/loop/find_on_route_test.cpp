#include "loop/find_on_route.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

namespace loop {
namespace {

control::State At(double X, double Y, double psi) {
  control::State z = control::State::Zero();
  z[control::kX] = X;
  z[control::kY] = Y;
  z[control::kPsi] = psi;
  return z;
}

class FindOnRouteTest : public testing::Test {
 protected:
  FindOnRouteTest() {
    for (int i = 0; i < 100; ++i) {
      points_.emplace_back(0.5 * i, 0.0);
    }
  }
  std::vector<Eigen::Vector2d> points_;
  control::RoadBounds road_{.left = 3.0, .right = -2.0};
};

TEST_F(FindOnRouteTest, NearestPointOnTheRoad) {
  const control::TimeReference reference(points_, 0.05);
  EXPECT_EQ(FindOnRoute(reference, road_, At(10.1, 2.9, 0.2), 0.5), 20);
  EXPECT_EQ(FindOnRoute(reference, road_, At(10.1, -1.9, -0.2), 0.5), 20);
  EXPECT_EQ(FindOnRoute(reference, road_, At(0.0, 0.0, 0.0), 0.5), 0);
}

TEST_F(FindOnRouteTest, NoneOffTheRoadBeforeItBehindItOrAcrossIt) {
  const control::TimeReference reference(points_, 0.05);
  EXPECT_FALSE(FindOnRoute(reference, road_, At(10.0, 3.1, 0.0), 0.5));
  EXPECT_FALSE(FindOnRoute(reference, road_, At(10.0, -2.1, 0.0), 0.5));
  EXPECT_FALSE(FindOnRoute(reference, road_, At(-1.0, 0.0, 0.0), 0.5));
  EXPECT_FALSE(FindOnRoute(reference, road_, At(60.0, 0.0, 0.0), 0.5));
  EXPECT_FALSE(FindOnRoute(reference, road_, At(10.0, 0.0, 0.6), 0.5));
}

TEST_F(FindOnRouteTest, WidthOfTheRoadIsThatBesideTheVehicle) {
  // The points are 0.5 m apart; the left edge comes nearer by 0.1 m per metre from x = 20 m to 40 m.
  const std::array samples{control::RoadSample{.s = 20.0, .bounds = {.left = 3.0, .right = -2.0}},
                           control::RoadSample{.s = 40.0, .bounds = {.left = 1.0, .right = -2.0}}};
  const control::RoadEdges edges(samples);
  const control::TimeReference reference(points_, 0.05);
  const auto found = [&](double X, double Y) {
    return FindOnRoute(reference, edges, At(X, Y, 0.0), 0.5).has_value();
  };
  EXPECT_TRUE(found(10.0, 2.9));
  EXPECT_TRUE(found(30.1, 1.98));
  EXPECT_FALSE(found(30.1, 1.995)) << "at the point 0.1 m behind, the edge is still at 2 m";
  EXPECT_FALSE(found(45.0, 1.1));
  EXPECT_TRUE(found(45.0, 0.9));
  EXPECT_TRUE(found(45.0, -1.9));
}

TEST_F(FindOnRouteTest, OfTwoLegsOnlyTheOneAlongWhichTheVehicleHeadsIsFound) {
  // There at y = 0, back at y = 3, 100 points each.
  for (int i = 0; i < 100; ++i) points_.emplace_back(49.5 - 0.5 * i, 3.0);
  const control::TimeReference reference(points_, 0.05);
  EXPECT_EQ(FindOnRoute(reference, road_, At(20.0, 2.0, 0.0), 0.5), 40);
  EXPECT_EQ(FindOnRoute(reference, road_, At(20.0, 2.0, std::numbers::pi), 0.5), 159);
}

TEST_F(FindOnRouteTest, CircuitBeginsWithItsFirstLap) {
  points_.clear();
  for (int i = 0; i < 1000; ++i) {
    const double angle = i * 2.0 * std::numbers::pi / 400.0;
    points_.emplace_back(50.0 * std::sin(angle), 50.0 - 50.0 * std::cos(angle));
  }
  const control::TimeReference reference(points_, 0.05);
  const double angle = 2.0 * std::numbers::pi * 10.3 / 400.0;
  EXPECT_EQ(
      FindOnRoute(reference, road_, At(50.0 * std::sin(angle), 50.0 - 50.0 * std::cos(angle), angle), 0.5),
      10);
}

}  // namespace
}  // namespace loop
