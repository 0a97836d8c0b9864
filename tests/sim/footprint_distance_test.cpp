#include "sim/footprint_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gtest/gtest.h"
#include "sim/ellipse_distance.hpp"
#include "tests/control/random.hpp"

namespace sim {
namespace {

using control::Footprint;
using control::Obstacle;
using Eigen::Vector2d;

constexpr Footprint kCar{.front = 1.95, .rear = 2.3, .half_width = 0.9};

struct Placed {
  Obstacle obstacle;
  Footprint footprint;
  Vector2d position;
  double heading;

  [[nodiscard]] double Distance() const { return FootprintDistance(obstacle, footprint, position, heading); }
  [[nodiscard]] Vector2d InMap(const Vector2d& body) const {
    return position + Eigen::Rotation2Dd(heading) * body;
  }
};

Placed Anywhere(control::testing::Random& random) {
  return {.obstacle = {.X = random.Uniform(-5.0, 5.0),
                       .Y = random.Uniform(-5.0, 5.0),
                       .r_x = random.Uniform(0.1, 2.0),
                       .r_y = random.Uniform(0.1, 2.0),
                       .heading = random.Uniform(-3.0, 3.0)},
          .footprint = {.front = random.Uniform(0.0, 3.0),
                        .rear = random.Uniform(0.0, 3.0),
                        .half_width = random.Uniform(0.0, 1.5)},
          .position = {random.Uniform(-5.0, 5.0), random.Uniform(-5.0, 5.0)},
          .heading = random.Uniform(-3.0, 3.0)};
}

// Least distance of points sampled along the rectangle's edges.
double LeastAlongEdges(const Placed& placed, int per_edge) {
  const auto corners = placed.footprint.Corners();
  double least = 1e9;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (int k = 0; k <= per_edge; ++k) {
      const Vector2d point =
          placed.InMap(corners[i] + (corners[(i + 1) % 4] - corners[i]) * (1.0 * k / per_edge));
      least = std::min(least, EllipseDistance(placed.obstacle, point.x(), point.y()));
    }
  }
  return least;
}

TEST(FootprintDistance, OutsideIsTheLeastDistanceOfThePointsOfTheRectangle) {
  control::testing::Random random(1);
  int outside = 0;
  for (int i = 0; i < 150; ++i) {
    const Placed placed = Anywhere(random);
    if (placed.Distance() < 0.05) continue;
    ++outside;
    // Points h apart over-estimate the least distance d by at most h² / (8 d).
    const double least = LeastAlongEdges(placed, 4000);
    EXPECT_LE(placed.Distance(), least + 1e-9) << i;
    EXPECT_NEAR(placed.Distance(), least, 1e-5) << i;
  }
  EXPECT_GT(outside, 75);
}

TEST(FootprintDistance, IsNegativeExactlyWhereRectangleAndEllipseShareAPoint) {
  control::testing::Random random(2);
  int contacts = 0;
  for (int i = 0; i < 150; ++i) {
    const Placed placed = Anywhere(random);
    const Vector2d centre = Eigen::Rotation2Dd(-placed.heading) *
                            (Vector2d(placed.obstacle.X, placed.obstacle.Y) - placed.position);
    const bool covers_centre = centre.x() < placed.footprint.front && centre.x() > -placed.footprint.rear &&
                               std::abs(centre.y()) < placed.footprint.half_width;
    const double least = LeastAlongEdges(placed, 1000);
    if (std::abs(least) < 1e-4) continue;  // the points may miss a touch
    const bool contact = covers_centre || least < 0.0;
    contacts += static_cast<int>(contact);
    EXPECT_EQ(placed.Distance() < 0.0, contact) << i;
  }
  EXPECT_GT(contacts, 10);
}

TEST(FootprintDistance, GoesThroughZeroWithoutAJumpWhenTheyMeet) {
  control::testing::Random random(3);
  for (int i = 0; i < 50; ++i) {
    Placed placed = Anywhere(random);
    // Bisects along a line for the place at which the two just touch.
    const Vector2d away = Vector2d::UnitX();
    double low = 0.0, high = 20.0;
    const Vector2d start(placed.obstacle.X, placed.obstacle.Y);
    for (int bisection = 0; bisection < 60; ++bisection) {
      const double middle = 0.5 * (low + high);
      placed.position = start + middle * away;
      (placed.Distance() < 0.0 ? low : high) = middle;
    }
    placed.position = start + (low - 1e-6) * away;
    EXPECT_NEAR(placed.Distance(), 0.0, 2e-5) << i;
    placed.position = start + (high + 1e-6) * away;
    EXPECT_NEAR(placed.Distance(), 0.0, 2e-5) << i;
  }
}

TEST(FootprintDistance, KnownPlaces) {
  const Obstacle ellipse{.r_x = 2.0, .r_y = 1.0, .heading = std::numbers::pi / 2.0};
  // Places beside, ahead of and behind a car that drives along x; the ellipse is across the road.
  EXPECT_NEAR(FootprintDistance(ellipse, kCar, {0.5, 5.0}, 0.0), 5.0 - 0.9 - 2.0, 1e-12);
  EXPECT_NEAR(FootprintDistance(ellipse, kCar, {-10.0, 0.1}, 0.0), 10.0 - 1.95 - 1.0, 1e-12);
  EXPECT_NEAR(FootprintDistance(ellipse, kCar, {10.0, 0.1}, 0.0), 10.0 - 2.3 - 1.0, 1e-12);
  EXPECT_NEAR(FootprintDistance(ellipse, kCar, {-10.0, 0.1}, std::numbers::pi), 10.0 - 2.3 - 1.0, 1e-12);
  // An overlap of 0.1 m at the front, and the car on top of the ellipse's centre.
  EXPECT_NEAR(FootprintDistance(ellipse, kCar, {-2.85, 0.0}, 0.0), -0.1, 1e-12);
  EXPECT_NEAR(FootprintDistance(ellipse, kCar, {0.0, 0.0}, 0.4), -1.0, 1e-12);
}

// Signed distance of a point to a box: inside, minus the distance to the nearest side.
double BoxDistance(const Obstacle& box, const Vector2d& point) {
  const Vector2d local = Eigen::Rotation2Dd(-box.heading) * (point - Vector2d(box.X, box.Y));
  const Vector2d beyond = local.cwiseAbs() - Vector2d(box.r_x, box.r_y);
  return beyond.maxCoeff() < 0.0 ? beyond.maxCoeff() : beyond.cwiseMax(0.0).norm();
}

// Least distance of points sampled all over the rectangle.
double LeastToBox(const Placed& placed, int per_side) {
  double least = 1e9;
  const control::Footprint& f = placed.footprint;
  for (int i = 0; i <= per_side; ++i) {
    for (int k = 0; k <= per_side; ++k) {
      const Vector2d body(-f.rear + (f.front + f.rear) * i / per_side,
                          f.half_width * (2.0 * k / per_side - 1.0));
      least = std::min(least, BoxDistance(placed.obstacle, placed.InMap(body)));
    }
  }
  return least;
}

TEST(FootprintDistance, ToABoxIsThatOfTheNearestPointsAndNegativeExactlyInContact) {
  control::testing::Random random(5);
  int contacts = 0;
  for (int i = 0; i < 400; ++i) {
    Placed placed = Anywhere(random);
    placed.obstacle.shape = control::ObstacleShape::kBox;
    const double least = LeastToBox(placed, 200);
    if (std::abs(least) < 0.02) continue;  // the points may miss a touch
    EXPECT_EQ(placed.Distance() < 0.0, least < 0.0) << i;
    contacts += static_cast<int>(least < 0.0);
    if (least < 0.0) continue;
    EXPECT_LE(placed.Distance(), least + 1e-9) << i;
    EXPECT_NEAR(placed.Distance(), least, 0.03) << i;  // points are at most 3 cm apart
  }
  EXPECT_GT(contacts, 40);
  EXPECT_LT(contacts, 360);
}

TEST(FootprintDistance, InABoxItIsTheLeastShiftThatSeparates) {
  control::testing::Random random(6);
  int contacts = 0;
  for (int i = 0; i < 400; ++i) {
    Placed placed = Anywhere(random);
    placed.obstacle.shape = control::ObstacleShape::kBox;
    const double depth = -placed.Distance();
    if (depth < 0.01) continue;
    ++contacts;
    const Vector2d start = placed.position;
    bool separated = false;
    for (int k = 0; k < 3600; ++k) {
      const double angle = k * std::numbers::pi / 1800;
      placed.position = start + 0.999 * depth * Vector2d(std::cos(angle), std::sin(angle));
      EXPECT_LT(placed.Distance(), 0.0) << i;
      placed.position = start + 1.001 * depth * Vector2d(std::cos(angle), std::sin(angle));
      separated = separated || placed.Distance() >= 0.0;
    }
    EXPECT_TRUE(separated) << i;
  }
  EXPECT_GT(contacts, 20);
}

TEST(FootprintDistance, KnownPlacesAtABox) {
  const Obstacle lorry{
      .r_x = 8.0, .r_y = 1.25, .heading = std::numbers::pi / 2.0, .shape = control::ObstacleShape::kBox};
  EXPECT_NEAR(FootprintDistance(lorry, kCar, {-10.0, 7.5}, 0.0), 10.0 - 1.95 - 1.25, 1e-12);
  // Corner to corner, 3 m along and 4 m across.
  EXPECT_NEAR(FootprintDistance(lorry, kCar, {-1.25 - 3.0 - 1.95, 8.0 + 4.0 + 0.9}, 0.0), 5.0, 1e-12);
  EXPECT_NEAR(FootprintDistance(lorry, kCar, {-1.25 - 1.95 + 0.1, 0.0}, 0.0), -0.1, 1e-12);
  EXPECT_NEAR(FootprintDistance(lorry, {}, {0.25, 1.0}, 0.3), -1.0, 1e-12);
}

TEST(FootprintDistance, OfAPointIsThatOfThePoint) {
  control::testing::Random random(4);
  for (int i = 0; i < 200; ++i) {
    Placed placed = Anywhere(random);
    placed.footprint = {};
    EXPECT_NEAR(placed.Distance(), EllipseDistance(placed.obstacle, placed.position.x(), placed.position.y()),
                1e-12);
  }
}

}  // namespace
}  // namespace sim
