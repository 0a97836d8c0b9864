#include "sim/footprint_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "control/vehicle/rectangle.hpp"
#include "sim/ellipse_distance.hpp"

namespace sim {
namespace {

using Eigen::Vector2d;

// The point of the segment from..to that is nearest to the origin.
Vector2d NearestOfSegment(const Vector2d& from, const Vector2d& to) {
  const Vector2d along = to - from;
  const double squared = along.squaredNorm();
  if (squared == 0.0) return from;
  return from + std::clamp(-from.dot(along) / squared, 0.0, 1.0) * along;
}

double EllipseToFootprint(const control::Obstacle& obstacle, const control::Footprint& footprint,
                          const Vector2d& position, double heading) {
  // The corners are transformed to the ellipse's frame and stay in clockwise order.
  const Eigen::Rotation2Dd to_ellipse(-obstacle.heading);
  const Eigen::Rotation2Dd turn(heading - obstacle.heading);
  const Vector2d from_ellipse = to_ellipse * (position - Vector2d(obstacle.X, obstacle.Y));
  std::array<Vector2d, 4> corners = footprint.Corners();
  for (Vector2d& corner : corners) corner = from_ellipse + turn * corner;
  const control::Obstacle centred{.r_x = obstacle.r_x, .r_y = obstacle.r_y};
  const Vector2d radii(obstacle.r_x, obstacle.r_y);

  // The ellipse's centre is in the rectangle if it is on no edge's outer side.
  bool centre_inside = true;
  Vector2d deepest(std::numeric_limits<double>::infinity(),
                   0.0);  // point of an edge, with the ellipse scaled to the unit circle
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& from = corners[i];
    const Vector2d& to = corners[(i + 1) % corners.size()];
    const Vector2d nearest = NearestOfSegment(from.cwiseQuotient(radii), to.cwiseQuotient(radii));
    if (nearest.squaredNorm() < deepest.squaredNorm()) deepest = nearest;
    distance = std::min(distance, EllipseDistance(centred, from.x(), from.y()));

    // Without contact, the nearest point is a corner, or it is on an edge opposite to the ellipse's point with the same
    // normal.
    const Vector2d along = to - from;
    const double length = along.norm();
    const Vector2d normal =
        Vector2d(-along.y(), along.x()) / length;  // outwards; NaN if the edge has no length
    centre_inside = centre_inside && normal.dot(-from) < 0.0;
    const double reach = radii.cwiseProduct(normal).norm();
    const Vector2d facing = -radii.cwiseAbs2().cwiseProduct(normal) / reach;
    const double beside = (facing - from).dot(along) / length;
    if (beside > 0.0 && beside < length) {
      const double gap = normal.dot(facing - from);
      if (gap >= 0.0) distance = std::min(distance, gap);
    }
  }
  if (centre_inside) return EllipseDistance(centred, 0.0, 0.0);
  if (deepest.squaredNorm() >= 1.0) return distance;
  const Vector2d point = deepest.cwiseProduct(radii);
  return EllipseDistance(centred, point.x(), point.y());
}

}  // namespace

double FootprintDistance(const control::Obstacle& obstacle, const control::Footprint& footprint,
                         const Vector2d& position, double heading) {
  if (obstacle.shape == control::ObstacleShape::kEllipse)
    return EllipseToFootprint(obstacle, footprint, position, heading);
  const control::Rectangle box = RectangleOf(obstacle), vehicle = RectangleOf(footprint, position, heading);
  const double overlap = Overlap(box, vehicle);
  return overlap > 0.0 ? -overlap : Distance(box, vehicle);
}

}  // namespace sim
