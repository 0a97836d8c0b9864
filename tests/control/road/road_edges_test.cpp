#include "control/road/road_edges.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "gtest/gtest.h"
#include "tests/control/random.hpp"

namespace control {
namespace {

constexpr double kFar = 1e6;

TEST(RoadEdges, OfAConstantRoadAreTheSameEverywhere) {
  const RoadEdges edges = RoadBounds{.left = 3.0, .right = -1.5};
  for (const double s : {-kFar, 0.0, 17.3, kFar}) {
    EXPECT_EQ(edges.At(s).left, 3.0);
    EXPECT_EQ(edges.At(s).right, -1.5);
  }
}

TEST(RoadEdges, AreLinearBetweenTheSamplesAndConstantBeyondThem) {
  const std::array samples{RoadSample{.s = 10.0, .bounds = {.left = 4.0, .right = -3.0}},
                           RoadSample{.s = 30.0, .bounds = {.left = 2.0, .right = -1.0}},
                           RoadSample{.s = 40.0, .bounds = {.left = 2.0, .right = -6.0}}};
  const RoadEdges edges(samples);
  const auto expect = [&](double s, double left, double right) {
    EXPECT_NEAR(edges.At(s).left, left, 1e-12) << s;
    EXPECT_NEAR(edges.At(s).right, right, 1e-12) << s;
  };
  for (const double s : {-kFar, 0.0, 10.0}) expect(s, 4.0, -3.0);
  expect(15.0, 3.5, -2.5);
  expect(20.0, 3.0, -2.0);
  expect(30.0, 2.0, -1.0);
  expect(36.0, 2.0, -4.0);
  for (const double s : {40.0, 40.1, kFar}) expect(s, 2.0, -6.0);
}

// Samples a millimetre to twelve metres apart, so that a cell has several samples or none.
TEST(RoadEdges, SamplesAtAnySpacingAreMetAndJoined) {
  testing::Random random(3);
  std::vector<RoadSample> samples{{.s = -7.3}};
  for (int k = 0; k < 300; ++k) {
    const double spacing = std::pow(10.0, random.Uniform(-3.0, 1.1));
    samples.push_back({.s = samples.back().s + spacing,
                       .bounds = {.left = random.Uniform(0.5, 6.0), .right = -random.Uniform(0.5, 6.0)}});
  }
  const RoadEdges edges(samples);
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
    const RoadSample &from = samples[k], &to = samples[k + 1];
    for (const double share : {0.0, 1e-3, 0.37, 0.5, 0.999}) {
      const RoadBounds between = edges.At(from.s + share * (to.s - from.s));
      EXPECT_NEAR(between.left, from.bounds.left + share * (to.bounds.left - from.bounds.left), 1e-8) << k;
      EXPECT_NEAR(between.right, from.bounds.right + share * (to.bounds.right - from.bounds.right), 1e-8)
          << k;
    }
  }
}

TEST(RoadEdges, TheNarrowestPlaceIsFoundBetweenTheSamplesAndAtThem) {
  const std::array samples{RoadSample{.s = 0.0, .bounds = {.left = 4.0, .right = -3.0}},
                           RoadSample{.s = 10.0, .bounds = {.left = 2.0, .right = -5.0}},
                           RoadSample{.s = 20.0, .bounds = {.left = 6.0, .right = -1.0}}};
  const RoadEdges edges(samples);
  const RoadBounds past =
      edges.Narrowest(5.0, 15.0);  // the left edge is nearest at s = 10, the right one at 15
  EXPECT_NEAR(past.left, 2.0, 1e-12);
  EXPECT_NEAR(past.right, -3.0, 1e-12);
  const RoadBounds before = edges.Narrowest(-20.0, -10.0), all = edges.Narrowest(-20.0, 50.0);
  EXPECT_NEAR(before.left, 4.0, 1e-12);
  EXPECT_NEAR(before.right, -3.0, 1e-12);
  EXPECT_NEAR(all.left, 2.0, 1e-12);
  EXPECT_NEAR(all.right, -1.0, 1e-12);
  EXPECT_NEAR(edges.Widest(), 6.0, 1e-12);
}

TEST(RoadEdges, InsetMovesBothEdgesInwards) {
  const std::array samples{RoadSample{.s = 0.0, .bounds = {.left = 4.0, .right = -3.0}},
                           RoadSample{.s = 10.0, .bounds = {.left = 2.0, .right = -1.0}}};
  const RoadEdges inset = RoadEdges(samples).Inset(0.9);
  EXPECT_NEAR(inset.At(5.0).left, 3.0 - 0.9, 1e-12);
  EXPECT_NEAR(inset.At(5.0).right, -2.0 + 0.9, 1e-12);
  EXPECT_NEAR(inset.Widest(), 4.0 - 0.9, 1e-12);
}

std::string ErrorOf(const std::vector<RoadSample>& samples) {
  try {
    const RoadEdges edges(samples);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(RoadEdges, SamplesThatMakeNoRoadAreRefusedByTheirNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ErrorOf({{.s = 0.0}, {.s = 1.0}}), "no error");
  EXPECT_EQ(ErrorOf({}), "no road samples");
  EXPECT_EQ(ErrorOf({{.s = 0.0}, {.s = 0.0}}), "road sample 1: s must be above that of its predecessor");
  EXPECT_EQ(ErrorOf({{.s = 0.0}, {.s = nan}}), "road sample 1: a value is not finite");
  EXPECT_EQ(ErrorOf({{.s = 0.0, .bounds = {.left = nan}}}), "road sample 0: a value is not finite");
  EXPECT_EQ(ErrorOf({{.s = 0.0, .bounds = {.left = -1.0, .right = -1.0}}}),
            "road sample 0: the left edge must be left of the right one");
}

}  // namespace
}  // namespace control
