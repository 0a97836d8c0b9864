#include "control/road/projection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "gtest/gtest.h"
#include "tests/control/random.hpp"

namespace control {
namespace {

using Eigen::Vector2d;
constexpr double kPi = std::numbers::pi;

// Distances by sample. Asking for a sample outside first..last is a failure.
class Distances {
 public:
  Distances(std::vector<double> values, int first, int last)
      : values_(std::move(values)), first_(first), last_(last) {}

  double operator()(int k) const {
    EXPECT_TRUE(k >= first_ && k <= last_) << k << " is not within " << first_ << " to " << last_;
    return values_.at(static_cast<std::size_t>(k));
  }

 private:
  std::vector<double> values_;
  int first_, last_;
};

TEST(NearestSample, IsTheBottomOfTheValleyOrTheEndOfTheRangeBeforeIt) {
  constexpr int kFirst = 3, kLast = 16;
  for (int bottom = 0; bottom < 20; ++bottom) {
    std::vector<double> valley;
    for (int k = 0; k < 20; ++k) valley.push_back(std::pow(k - bottom, 2));
    const Distances distance(valley, kFirst, kLast);
    for (int from = kFirst; from <= kLast; ++from) {
      EXPECT_EQ(NearestSample(distance, from, kFirst, kLast), std::clamp(bottom, kFirst, kLast)) << from;
    }
  }
}

TEST(NearestSample, StaysInTheValleyWhereItBeginsAndLeavesARidgeForwards) {
  const Distances distance({5.0, 3.0, 1.0, 4.0, 6.0, 2.0, 7.0}, 0, 6);
  for (const int from : {0, 1, 2, 3}) EXPECT_EQ(NearestSample(distance, from, 0, 6), 2) << from;
  for (const int from : {5, 6}) EXPECT_EQ(NearestSample(distance, from, 0, 6), 5) << from;
  EXPECT_EQ(NearestSample(distance, 4, 0, 6), 5) << "from the ridge, though the other valley is deeper";
}

TEST(NearestOfAll, IsTheFirstOfTheLeastWithinTheRange) {
  testing::Random random(11);
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<double> values;
    for (int k = 0; k < 12; ++k) values.push_back(random.Integer(0, 5));  // many are equal
    const int first = random.Integer(0, 11), last = random.Integer(first, 11);
    const auto least = std::min_element(values.begin() + first, values.begin() + last + 1);
    EXPECT_EQ(NearestOfAll(Distances(values, first, last), first, last), least - values.begin());
  }
}

TEST(OffsetFrom, IsTheWayAheadAndToTheLeftThatLeadsToThePosition) {
  const PathOffset north = OffsetFrom({1.0, 2.0}, kPi / 2.0, {-3.0, 7.0});  // the path leads in Y direction
  EXPECT_NEAR(north.ahead, 5.0, 1e-12);
  EXPECT_NEAR(north.left, 4.0, 1e-12);
  testing::Random random(12);
  for (int trial = 0; trial < 200; ++trial) {
    const auto point = random.Filled<Vector2d>(50.0), position = random.Filled<Vector2d>(50.0);
    const double psi = random.Uniform(-4.0 * kPi, 4.0 * kPi);
    const auto [ahead, left] = OffsetFrom(point, psi, position);
    // Drives `ahead`, turns left by a right angle and drives `left`.
    const Vector2d corner = point + ahead * Vector2d(std::cos(psi), std::sin(psi));
    const double turned = psi + kPi / 2.0;
    const Vector2d reached = corner + left * Vector2d(std::cos(turned), std::sin(turned));
    EXPECT_LT((reached - position).norm(), 1e-11);
  }
}

TEST(Beside, IsPerpendicularToTheRouteAndToTheLeftOfIt) {
  const Vector2d left = Beside(RoutePoint{.X = 4.0, .Y = 1.0, .psi = kPi / 2.0}, 1.5);
  EXPECT_NEAR(left.x(), 2.5, 1e-12);
  EXPECT_NEAR(left.y(), 1.0, 1e-12);
  testing::Random random(13);
  for (int trial = 0; trial < 200; ++trial) {
    const RoutePoint point{.X = random.Uniform(-50.0, 50.0),
                           .Y = random.Uniform(-50.0, 50.0),
                           .psi = random.Uniform(-4.0 * kPi, 4.0 * kPi)};
    const double lateral = random.Uniform(-5.0, 5.0);
    const PathOffset offset = OffsetFrom(Position(point), point.psi, Beside(point, lateral));
    EXPECT_NEAR(offset.ahead, 0.0, 1e-12);
    EXPECT_NEAR(offset.left, lateral, 1e-12);
    State z = State::Zero();
    z << point.X, point.Y, 0.0, 0.0, point.psi, 0.0;
    EXPECT_LT((Beside(z, lateral) - Beside(point, lateral)).norm(), 1e-12);
  }
}

TEST(InterpolateBeside, FindsTheFootOnALineAndItsExtensions) {
  std::vector<State> line(5, State::Zero());
  for (int k = 0; k < 5; ++k) line[static_cast<std::size_t>(k)] << 2.0 * k, 0.0, 10.0 + k, 0.0, 0.0, 0.0;
  for (const double x : {-1.5, 0.0, 3.0, 7.9, 9.0}) {
    const State beside = InterpolateBeside({x, 1.0}, line);
    EXPECT_NEAR(beside[kX], x, 1e-12);
    EXPECT_NEAR(beside[kUpsilon], 10.0 + 0.5 * x, 1e-12);
    EXPECT_EQ(beside[kY], 0.0);
  }
}

TEST(InterpolateBeside, OutsideACornerIsOnTheExtensionOfTheLegBeforeIt) {
  std::vector<State> corner(3, State::Zero());
  corner[1][kX] = 4.0;
  corner[2][kX] = 4.0;
  corner[2][kY] = 4.0;
  const State beside = InterpolateBeside({5.0, -1.0}, corner);
  EXPECT_NEAR(beside[kY], 0.0, 1e-12);
  EXPECT_NEAR(beside[kX], 5.0, 1e-12);
}

}  // namespace
}  // namespace control
