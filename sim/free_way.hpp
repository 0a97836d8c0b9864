// Whether a vehicle that stands could drive on: the rule by which a judge tells waiting from a deadlock.
//
// The way is free if the vehicle's rear axle can follow one of these paths until it is 15 m further along the road:
// straight on along the vehicle's axis for 0, 2, ... 8 m; an arc of 6 m radius to a heading of up to 60° off the road, in
// steps of 5°; straight on for 0, 1, ... 4 m; an arc of the same radius back to the road's direction; then along the road.
// The vehicle's rectangle must overlap no object and stay on the road; along the road, also if it is 0.3 m wider on
// either side.
//
// An object is the rectangle, along and across the road, of all that it covers within the next 4 s at its velocity. One
// that is behind and covers offsets that the vehicle covers is not in the way. The road is taken as straight, its width as
// that at the same arc length.
#pragma once

#include <span>

#include "control/road/road_edges.hpp"
#include "control/vehicle/footprint.hpp"
#include "sim/road_body.hpp"

namespace sim {

// `l_r`: from the centre of gravity to the rear axle [m].
[[nodiscard]] bool WayIsFree(const RoadBody& vehicle, const control::Footprint& footprint, double l_r,
                             std::span<const RoadBody> objects, const control::RoadEdges& edges);

}  // namespace sim
