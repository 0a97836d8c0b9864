#include "safety/mode_machine.hpp"

#include <algorithm>

namespace safety {
namespace {

// A fault that stops the vehicle at once.
std::optional<Cause> HardFault(const ModeInputs& inputs) {
  const auto fault = InputFault(inputs);
  if (fault && IsHard(*fault)) return fault;
  if (inputs.route_left <= 0) return Cause::kRouteEnd;
  if (!inputs.plan_usable) return Cause::kPlanExhausted;
  if (inputs.stop_due) return Cause::kStopDue;
  return std::nullopt;
}

Cause SilenceCause(const ModeInputs& inputs) {
  return inputs.bus_up ? Cause::kSilent : Cause::kBusDown;
}

// True if nothing speaks against driving on.
bool CanDriveOn(const ModeInputs& inputs) {
  return inputs.Healthy() && inputs.engage && inputs.plan_new && inputs.route_left > 0 &&
         !PresentFault(inputs);
}

int CountHealthy(const ModeState& state, const ModeInputs& inputs) {
  return inputs.Healthy() ? std::min(state.healthy_cycles + 1, kHealthyCycles) : 0;
}

}  // namespace

bool ModeInputs::Healthy() const {
  return bus_up && state_fresh && obstacles_fresh && request_fresh && !internal_error;
}

ModeState Next(const ModeState& state, const ModeInputs& inputs, const ModeSettings& settings) {
  ModeState next = state;
  next.healthy_cycles = CountHealthy(state, inputs);
  const bool withdrawn = inputs.request_fresh && (inputs.released || !inputs.engage);
  const auto enter = [&next](bus::Mode mode, Cause cause) {
    next.previous = next.mode;
    next.mode = mode;
    next.cause = cause;
    next.armed = false;
    next.recovered_cycles = next.standing_cycles = 0;
  };

  if (inputs.internal_error) {
    if (state.mode != bus::Mode::kFault) {
      enter(bus::Mode::kFault, Cause::kInternalError);
    }
    return next;
  }
  switch (state.mode) {
    case bus::Mode::kInit:
      if (next.healthy_cycles == kHealthyCycles) {
        enter(bus::Mode::kStandby, Cause::kInputsHealthy);
      }
      break;
    case bus::Mode::kStandby:
      if (EngagementRequested(state, inputs) && inputs.plan_usable) {
        enter(bus::Mode::kActive, Cause::kEngaged);
      } else {
        const bool edge_waits = !inputs.state_new && !inputs.override_seen && RisingEdge(state, inputs);
        next.armed = inputs.request_fresh && (!inputs.engage || edge_waits);
      }
      break;
    case bus::Mode::kActive:
    case bus::Mode::kDegraded:
      if (inputs.override_seen) {
        enter(bus::Mode::kStandby, Cause::kOverride);
      } else if (withdrawn) {
        enter(bus::Mode::kStandby, Cause::kReleased);
      } else if (inputs.silent) {
        enter(bus::Mode::kFault, SilenceCause(inputs));
      } else if (inputs.route_left <= 0 && inputs.standstill) {
        enter(bus::Mode::kStandby, Cause::kRouteEnd);
      } else if (const auto hard = HardFault(inputs)) {
        enter(bus::Mode::kSafeStop, *hard);
      } else if (const auto soft = PresentFault(inputs)) {
        const int left = state.mode == bus::Mode::kDegraded ? state.degraded_left : settings.degraded_cycles;
        if (left == 0) {
          enter(bus::Mode::kSafeStop, *soft);
        } else if (state.mode == bus::Mode::kActive) {
          enter(bus::Mode::kDegraded, *soft);
        }
        next.degraded_left = std::max(left - 1, 0);
      } else if (state.mode == bus::Mode::kDegraded) {
        enter(bus::Mode::kActive, Cause::kRecovered);
      }
      break;
    case bus::Mode::kSafeStop:
      next.recovered_cycles = CanDriveOn(inputs) ? state.recovered_cycles + 1 : 0;
      next.standing_cycles = inputs.standstill ? state.standing_cycles + 1 : 0;
      if (inputs.override_seen) {
        enter(bus::Mode::kStandby, Cause::kOverride);
      } else if (withdrawn) {
        enter(bus::Mode::kStandby, Cause::kReleased);
      } else if (inputs.silent) {
        enter(bus::Mode::kFault, SilenceCause(inputs));
      } else if (next.recovered_cycles == kHealthyCycles) {
        enter(bus::Mode::kActive, Cause::kRecovered);
      } else if (inputs.standstill && inputs.route_left <= 0) {
        enter(bus::Mode::kStandby, Cause::kRouteEnd);
      } else if (next.standing_cycles > settings.hold_cycles) {
        enter(bus::Mode::kStandby, Cause::kStandstill);
      }
      break;
    default:  // kFault
      if (inputs.Healthy() && !inputs.engage) {
        enter(bus::Mode::kStandby, Cause::kRecovered);
      }
      break;
  }
  return next;
}

bool RisingEdge(const ModeState& state, const ModeInputs& inputs) {
  return inputs.engage && (state.armed || inputs.released);
}

bool EngagementRequested(const ModeState& state, const ModeInputs& inputs) {
  const bool asked = state.mode == bus::Mode::kStandby && RisingEdge(state, inputs) && inputs.state_new;
  const bool possible = inputs.near_route && inputs.route_left > 0 && !inputs.override_seen;
  return asked && possible && CountHealthy(state, inputs) == kHealthyCycles;
}

std::optional<Cause> InputFault(const ModeInputs& inputs) {
  if (!inputs.bus_up) return Cause::kBusDown;
  if (!inputs.state_fresh) return inputs.state_rejected ? Cause::kStateInvalid : Cause::kStateStale;
  if (!inputs.obstacles_fresh) return Cause::kObstaclesStale;
  if (!inputs.request_fresh) return Cause::kDriverRequestStale;
  return std::nullopt;
}

std::optional<Cause> PresentFault(const ModeInputs& inputs) {
  const auto fault = InputFault(inputs);
  return fault ? fault : inputs.plan_fault;
}

}  // namespace safety
