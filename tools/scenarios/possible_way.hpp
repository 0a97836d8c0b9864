// Whether a scenario leaves a vehicle any way at all, judged without a controller: an upper bound, by which the failures
// of a controller are told from those of the task.
//
// A point mass keeps the target speed along the middle of the road. Of the road's friction it may use 0.7 μ g, less the
// greatest υ² |κ| of the stretch between where the obstacle is perceived and where it is met: a.
//  - It can pass an obstacle if beside it, or between it and others at the same place, there is a gap as wide as the
//    vehicle and 0.2 m on either side, on the side that is told if one is, and if the shift y from the road's middle into
//    the gap can be made in the time t from perception to encounter: half of it towards the gap, half back to the road's
//    direction, t >= 2 sqrt(y / a).
//  - Else it can stop if it comes to rest before the obstacle, braking with a from where that is perceived, the front
//    end short of it; never before an obstacle that comes towards it.
// What the obstacles before demanded counts for nothing.
#pragma once

#include "sim/scenario.hpp"

namespace tools {

enum class PossibleWay {
  kPass,  // past every obstacle
  kStop,  // no way past one of them, but it can stop before the first such
  kNone,  // neither
};

// The route's target speed must be constant (tools/scenarios/encounter.hpp).
[[nodiscard]] PossibleWay FindPossibleWay(const sim::Scenario& scenario);
[[nodiscard]] const char* NameOf(PossibleWay way);  // "pass", "stop", "none"

}  // namespace tools
