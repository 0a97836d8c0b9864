// A road that narrows, for tests.
#pragma once

#include <array>

#include "control/road/road_edges.hpp"

namespace control::testing {

// 4 m to either side up to s = `from` [m]; the right edge is `right` [m], negative, from s = `to` on.
inline RoadEdges NarrowingOnTheRight(double from, double to, double right) {
  return RoadEdges(std::array{RoadSample{.s = from, .bounds = {.left = 4.0, .right = -4.0}},
                              RoadSample{.s = to, .bounds = {.left = 4.0, .right = right}}});
}

}  // namespace control::testing
