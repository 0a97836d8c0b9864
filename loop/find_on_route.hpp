// Finds a vehicle on the route.
#pragma once

#include <optional>

#include "control/road/road_edges.hpp"
#include "control/road/time_reference.hpp"
#include "control/vehicle/types.hpp"

namespace loop {

// Index of the reference point beside the vehicle: the first one along the route that is closer than its neighbours,
// with the vehicle between the road's edges, no further ahead or behind than the next point is, and a heading that
// differs by at most `max_heading_error` [rad]. nullopt if there is none. The first one is taken so that a circuit
// begins with its first lap.
[[nodiscard]] std::optional<int> FindOnRoute(const control::TimeReference& reference,
                                             const control::RoadEdges& edges, const control::State& z,
                                             double max_heading_error);

}  // namespace loop
