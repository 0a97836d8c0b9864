#include "control/road/time_reference.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace control {
namespace {

using Eigen::Vector2d;
using ::testing::HasSubstr;
constexpr double kStep = 0.05;
constexpr double kPi = std::numbers::pi;

std::vector<Vector2d> Line(double heading, double speed, int count) {
  std::vector<Vector2d> points;
  for (int k = 0; k < count; ++k) {
    points.emplace_back(5.0 + k * kStep * speed * std::cos(heading),
                        -3.0 + k * kStep * speed * std::sin(heading));
  }
  return points;
}

// Circle of radius r about the origin, counter-clockwise if angle_step > 0.
std::vector<Vector2d> Circle(double r, double angle_step, int count) {
  std::vector<Vector2d> points;
  for (int k = 0; k < count; ++k)
    points.emplace_back(r * std::cos(k * angle_step), r * std::sin(k * angle_step));
  return points;
}

std::string MessageOf(const std::vector<Vector2d>& points, double t_s = kStep) {
  try {
    const TimeReference reference(points, t_s);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(TimeReference, LineHasItsSpeedAndHeadingInEveryQuadrant) {
  for (double heading = -3.1; heading <= 3.14; heading += 0.4) {
    const TimeReference reference(Line(heading, 12.0, 30), kStep);
    ASSERT_EQ(reference.size(), 30);
    for (int k = 0; k < reference.size(); ++k) {
      EXPECT_NEAR(reference[k][kUpsilon], 12.0, 1e-9);
      EXPECT_NEAR(reference[k][kNu], 0.0, 1e-9);
      EXPECT_NEAR(reference[k][kPsi], heading, 1e-9);
      EXPECT_NEAR(reference[k][kOmega], 0.0, 1e-9);
      EXPECT_NEAR(reference[k][kX], 5.0 + k * kStep * 12.0 * std::cos(heading), 1e-12);
    }
  }
}

TEST(TimeReference, DriveInNegativeXKeepsOneHeading) {
  std::vector<Vector2d> points;
  for (int k = 0; k < 40; ++k)
    points.emplace_back(-0.5 * k, k % 2 == 0 ? 1e-4 : -1e-4);  // atan2 alternates ±π
  const TimeReference reference(points, kStep);
  for (int k = 0; k < reference.size(); ++k) {
    EXPECT_NEAR(std::abs(reference[k][kPsi]), kPi, 1e-3);
    EXPECT_GT(reference[k][kPsi] * reference[0][kPsi], 0.0) << "jump at " << k;
    EXPECT_LT(std::abs(reference[k][kOmega]), 0.1);
  }
}

// Chords of a circle: length 2 r sin(α/2), heading half a step ahead of the tangent at the chord's start.
TEST(TimeReference, CircleBothWaysRoundUnwrapsPastPi) {
  const double r = 50.0;
  for (const double angle : {0.01, -0.01}) {
    const int count = static_cast<int>(4.5 * kPi / std::abs(angle));  // more than two turns
    const TimeReference reference(Circle(r, angle, count), kStep);
    for (int k = 0; k < count - 1; ++k) {
      const double along = angle > 0.0 ? kPi / 2.0 : -kPi / 2.0;
      EXPECT_NEAR(reference[k][kPsi], along + (k + 0.5) * angle, 1e-9) << k;
      EXPECT_NEAR(reference[k][kUpsilon], 2.0 * r * std::sin(0.005) / kStep, 1e-9);
      EXPECT_NEAR(reference[k][kNu], 0.0, 1e-9);
      if (k < count - 2) {
        EXPECT_NEAR(reference[k][kOmega], angle / kStep, 1e-7);
      }
    }
    EXPECT_EQ(reference[count - 1][kOmega], 0.0);
    EXPECT_EQ(reference[count - 1][kPsi], reference[count - 2][kPsi]);
  }
}

TEST(TimeReference, WindowIsThePartAskedFor) {
  const TimeReference reference(Circle(30.0, 0.02, 100), kStep);
  std::vector<State> window(9);
  reference.Window(17, window);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(window[static_cast<std::size_t>(i)], reference[17 + i]);
}

TEST(TimeReference, WindowPastTheEndGoesOnStraight) {
  const TimeReference reference(Circle(30.0, 0.02, 100), kStep);
  std::vector<State> window(16);
  for (const int from : {90, 99, 200}) {
    reference.Window(from, window);
    const State& last = reference[99];
    for (int i = 0; i < 16; ++i) {
      const int beyond = from + i - 99;
      if (beyond < 0) continue;
      const State& z = window[static_cast<std::size_t>(i)];
      const double distance = beyond * kStep * last[kUpsilon];
      EXPECT_NEAR(z[kX], last[kX] + distance * std::cos(last[kPsi]), 1e-9);
      EXPECT_NEAR(z[kY], last[kY] + distance * std::sin(last[kPsi]), 1e-9);
      EXPECT_EQ(z.tail<4>(), last.tail<4>());
    }
  }
}

TEST(TimeReference, ArcLengthIsThatOfTheCircleAndGoesOnAtTheLastSpeed) {
  const double radius = 30.0, angle = 0.02;
  const TimeReference reference(Circle(radius, angle, 100), kStep);
  for (const int k : {0, 1, 50, 99, 100, 150}) {
    EXPECT_NEAR(reference.ArcLength(k), k * radius * angle, 1e-4 * k * radius * angle) << k;
  }
}

TEST(TimeReference, RefusedPointIsNamed) {
  std::vector<Vector2d> points = Line(0.0, 10.0, 10);
  points[6] = points[5];
  EXPECT_THAT(MessageOf(points), AllOf(HasSubstr("5"), HasSubstr("6"), HasSubstr("coincide")));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    points = Line(0.0, 10.0, 10);
    points[7].y() = bad;
    EXPECT_THAT(MessageOf(points), AllOf(HasSubstr("7"), HasSubstr("finite")));
  }
  EXPECT_THAT(MessageOf({Vector2d(1.0, 2.0)}), HasSubstr("two points"));
  EXPECT_THAT(MessageOf(Line(0.0, 10.0, 10), 0.0), HasSubstr("t_s"));
  EXPECT_THAT(MessageOf(Line(0.0, 10.0, 10), std::numeric_limits<double>::quiet_NaN()), HasSubstr("t_s"));
}

}  // namespace
}  // namespace control
