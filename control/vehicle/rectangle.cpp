#include "control/vehicle/rectangle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "control/vehicle/geometry.hpp"

namespace control {
namespace {

using Eigen::Vector2d;

// Columns: unit vectors along and across the heading.
Eigen::Matrix2d AxesOf(const Rectangle& rectangle) {
  return Eigen::Rotation2Dd(rectangle.heading).toRotationMatrix();
}

// The least distance of a corner of `b` to `a`.
double DistanceOfCorners(const Rectangle& a, const Rectangle& b) {
  double least = std::numeric_limits<double>::infinity();
  for (const double ahead : {-1.0, 1.0}) {
    for (const double left : {-1.0, 1.0}) {
      const Vector2d corner = b.centre + Rotate(b.heading, b.half_sides.cwiseProduct(Vector2d(ahead, left)));
      const Vector2d from_centre = Rotate(-a.heading, corner - a.centre).cwiseAbs();
      least = std::min(least, (from_centre - a.half_sides).cwiseMax(0.0).norm());
    }
  }
  return least;
}

}  // namespace

Rectangle RectangleOf(const Footprint& footprint, const Vector2d& position, double heading) {
  return {.centre = position + 0.5 * (footprint.front - footprint.rear) * Along(heading),
          .half_sides = {0.5 * (footprint.front + footprint.rear), footprint.half_width},
          .heading = heading};
}

Rectangle RectangleOf(const Obstacle& obstacle) {
  return {.centre = {obstacle.X, obstacle.Y},
          .half_sides = {obstacle.r_x, obstacle.r_y},
          .heading = obstacle.heading};
}

// Two convex polygons are apart if and only if a side's normal separates them, and the shortest way apart is along one.
double Overlap(const Rectangle& a, const Rectangle& b) {
  const Eigen::Matrix2d A = AxesOf(a), B = AxesOf(b);
  const Eigen::Matrix2d turn = (A.transpose() * B).cwiseAbs();
  const Vector2d between = b.centre - a.centre;
  const Vector2d along_a = a.half_sides + turn * b.half_sides - (A.transpose() * between).cwiseAbs();
  const Vector2d along_b =
      b.half_sides + turn.transpose() * a.half_sides - (B.transpose() * between).cwiseAbs();
  return std::min(along_a.minCoeff(), along_b.minCoeff());
}

// Of two convex polygons that are apart, one of the two nearest points can be a corner.
double Distance(const Rectangle& a, const Rectangle& b) {
  if (Overlap(a, b) > 0.0) return 0.0;
  return std::min(DistanceOfCorners(a, b), DistanceOfCorners(b, a));
}

}  // namespace control
