// The geometry of an obstacle's outline, for either shape. Enlarged by a margin [m], an ellipse has semi-axes that are
// longer by it; a box reaches it further on every side, and its corners become arcs of this radius.
#pragma once

#include <Eigen/Core>

#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"

namespace control {

class EnlargedObstacle {
 public:
  explicit EnlargedObstacle(const Obstacle& obstacle, double margin = 0.0);

  // Half the width in the direction of the unit vector `direction` [m].
  [[nodiscard]] double Support(const Eigen::Vector2d& direction) const;

  // The slope dy/dτ of the edge y(τ) on the side of `n`, where τ is measured from the centre along the unit vector `t`
  // and y along the unit vector `n` across it. It is that at a τ in [rear, front], as near as possible to the edge's
  // widest place. Beyond its ends, the slope of an ellipse is that close to the end, the slope of a box is infinite.
  [[nodiscard]] double EdgeSlope(const Eigen::Vector2d& t, const Eigen::Vector2d& n, double rear,
                                 double front) const;

 private:
  [[nodiscard]] double EllipseSlope(const Eigen::Vector2d& t, const Eigen::Vector2d& n, double rear,
                                    double front) const;
  [[nodiscard]] double BoxSlope(const Eigen::Vector2d& t, const Eigen::Vector2d& n, double rear,
                                double front) const;

  ObstacleShape shape_;
  Eigen::Matrix2d axes_;   // columns: unit vectors along and across the heading
  Eigen::Vector2d radii_;  // semi-axes, enlarged, or half sides, not enlarged [m]
  Eigen::Matrix2d matrix_ =
      Eigen::Matrix2d::Zero();  // of an ellipse: points p with (p − centre)ᵀ S⁻¹ (p − centre) ≤ 1
  double margin_;               // [m]
};

// Roughly how far the rectangle of a vehicle in state `z` reaches into the obstacle [m]; negative if they are apart.
// Of things that are far apart, it is the distance of circles about them. For an ellipse it is the depth as a fraction of the radius times the smaller semi-axis; for a box, the least shift
// that separates them.
[[nodiscard]] double Overlap(const Obstacle& obstacle, const Footprint& footprint, const State& z);

// The radius of the circle about the obstacle's centre that encloses it [m].
[[nodiscard]] double EnclosingRadius(const Obstacle& obstacle);

// The obstacle if it is an ellipse; otherwise the ellipse through the corners of the box with the least area: its
// semi-axes are √2 times the half sides.
[[nodiscard]] Obstacle EnclosingEllipse(const Obstacle& obstacle);

}  // namespace control
