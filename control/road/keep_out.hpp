// Half-spaces that keep a vehicle with a footprint out of obstacles (paper, Section linobs, for a vehicle that is not
// a point): the tangent of the enlarged obstacle (control/vehicle/obstacle_geometry.hpp) on the passing side, about the
// predicted pose. Keeping the vehicle's rectangle beyond it takes one row per corner; the two nearest corners are
// enough, since the others follow while the heading changes little.
//
// Beside the obstacle, the tangent is parallel to the road; before and behind its widest place, it turns with the
// obstacle's edge, by at most 45°, so that a row never becomes a wall across the road.
#pragma once

#include <optional>

#include "control/road/halfspace.hpp"
#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"

namespace control {

// The obstacle `time` [s] later, at constant velocity.
[[nodiscard]] Obstacle Predict(Obstacle obstacle, double time);

// Half the obstacle's width in the direction of the unit vector `direction` [m].
[[nodiscard]] double SupportOf(const Obstacle& obstacle, const Eigen::Vector2d& direction);

// The half-space that lets the vehicle at `z` pass on the given side (not kUnknown) of the obstacle, enlarged by
// `margin` [m], on a road along the unit vector t; nullopt if the vehicle is more than `reach` [m] before or behind it.
[[nodiscard]] std::optional<HalfSpace> PassingHalfSpace(const Obstacle& obstacle, PassingSide side,
                                                        const State& z, const Eigen::Vector2d& t,
                                                        const Footprint& footprint, double margin,
                                                        double reach);

// The half-space before the obstacle, across a road along the unit vector t, for a vehicle that cannot pass.
[[nodiscard]] HalfSpace HalfSpaceBefore(const Obstacle& obstacle, const Eigen::Vector2d& t, double margin);

}  // namespace control
