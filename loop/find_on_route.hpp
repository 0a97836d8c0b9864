// Where on the route a vehicle stands.
#pragma once

#include <optional>

#include "control/road/time_reference.hpp"
#include "control/vehicle/types.hpp"

namespace loop {

// Index of the reference point beside the vehicle: the first one along the route that is nearest among its
// neighbours, has the vehicle between the road's edges and not further ahead or behind than its neighbours
// are, and differs from its heading by at most `max_heading_error` [rad]. Nothing if there is none. The first
// one, so that a route that passes the same place again, a circuit, begins with its first lap.
[[nodiscard]] std::optional<int> FindOnRoute(const control::TimeReference& reference,
                                             const control::RoadBounds& road, const control::State& z,
                                             double max_heading_error);

}  // namespace loop
