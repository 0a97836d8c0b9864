// Whether a vehicle can pass a scenario's obstacles or stop at all, judged without a controller: an upper bound that
// separates the failures of a controller from impossible tasks.
//
// A point mass keeps the target speed along the middle of the road. Its available acceleration a is 0.7 μ g less the
// greatest υ² |κ| between the place where the obstacle is perceived and the place where it is met.
//  - It can pass an obstacle if there is a gap beside it, or between it and others at the same place, at least as wide
//    as the vehicle plus 0.2 m on either side, on the prescribed side if there is one, and if the time t from
//    perception to encounter suffices for the shift y from the road's middle into the gap: it accelerates towards the
//    gap for the first half of t and back to the road's direction for the second, t >= 2 sqrt(y / a).
//  - Otherwise it can stop if, braking with a from the place of perception, its front comes to rest before the
//    obstacle; never before an obstacle that moves towards it.
// Each obstacle is judged independently of those before it.
#pragma once

#include "sim/scenario.hpp"

namespace tools {

enum class PossibleWay {
  kPass,  // past every obstacle
  kStop,  // it cannot pass one of them, but can stop before the first such obstacle
  kNone,  // neither
};

// The route's target speed must be constant (tools/scenarios/encounter.hpp).
[[nodiscard]] PossibleWay FindPossibleWay(const sim::Scenario& scenario);
[[nodiscard]] const char* NameOf(PossibleWay way);  // "pass", "stop", "none"

}  // namespace tools
