// Who drives: a pure function of the mode before and of what is known in this cycle. One step a cycle; cycles
// are counted and no time is read, so that a run is repeatable to the bit.
//
//   Init ──► Standby ──► Active ◄──► Degraded ──► SafeStop ──► Standby        Fault from anywhere, back to Standby
//              ▲           │            │             │
//              └───────────┴────────────┴─────────────┘  override, request withdrawn
//
// Engagement needs a rising edge of the driver's request, seen in Standby, while all inputs are healthy, the
// vehicle stands near the route, nobody overrides and a first plan exists. An edge that comes while one of
// these is missing is spent: the driver has to ask again. (An edge in a cycle without a new state waits for
// the next state.)
//
// Degraded drives on although something is missing that can be done without for a while: a new plan (the last one
// goes on), the obstacles or the driver's request. Its countdown says for how many cycles more; then, and at once
// where there is no doing without, SafeStop brings the vehicle to a stop along its path.
//
// Whoever has been silent for long while commanding, the bus away or the process stopped, has lost the vehicle to
// others: no command is enabled again before the driver asks anew.
#pragma once

#include <cstdint>
#include <optional>

#include "bus/messages.hpp"
#include "safety/fault.hpp"

namespace safety {

using bus::Commands;
using bus::Drives;
using bus::Mode;

// Consecutive healthy cycles before Init is left and before engagement.
inline constexpr int kHealthyCycles = 3;

struct ModeInputs {
  bool bus_up = false;
  bool state_new = false;  // a state set was completed for this cycle
  bool state_fresh = false;
  bool state_rejected = false;  // of a state that is not fresh: its frames come, but are refused
  bool obstacles_fresh = false;
  bool request_fresh = false;
  bool engage = false;         // as last requested
  bool released = false;       // engage was seen false since the cycle before
  bool override_seen = false;  // brake or steering override since the cycle before
  bool near_route = false;     // on the road, along it, fast enough
  bool plan_usable = false;    // a command can be taken from a plan that is not exhausted
  int plan_left = 0;           // cycles after this one for which the same plan has a command
  std::optional<bus::ModeCause> plan_fault =
      std::nullopt;             // why this cycle has no new plan, if it should have
  std::int64_t route_left = 0;  // steps for which the route is long enough to plan on it, off the route 0
  bool standstill = false;      // a fresh state says so
  bool silent = false;          // for many cycles no command has gone out
  bool internal_error = false;

  [[nodiscard]] bool Healthy() const {
    return bus_up && state_fresh && obstacles_fresh && request_fresh && !internal_error;
  }
};

// What is wrong with the inputs, the gravest first: the reason of a stop, or why it would not engage.
[[nodiscard]] std::optional<Cause> InputFault(const ModeInputs& inputs);
// The same, or else why there is no new plan.
[[nodiscard]] std::optional<Cause> PresentFault(const ModeInputs& inputs);

struct ModeSettings {
  int degraded_cycles = 20;  // in a row, before the vehicle is stopped; ≥ 0
};

struct ModeState {
  bus::Mode mode = bus::Mode::kInit;
  bus::Mode previous = bus::Mode::kInit;  // before the present one
  Cause cause = Cause::kStart;
  int healthy_cycles = 0;  // in a row, up to kHealthyCycles
  bool armed = false;      // in Standby: engage was seen false, so its next true is a rising edge
  int degraded_left = 0;   // in Degraded: cycles that may follow in it
};

[[nodiscard]] ModeState Next(const ModeState& state, const ModeInputs& inputs,
                             const ModeSettings& settings = {});

// In Standby: the driver's request went from false to true.
[[nodiscard]] bool RisingEdge(const ModeState& state, const ModeInputs& inputs);

// True if Next would engage, given a plan: the cycle then has to make one. Its answer does not depend on
// `inputs.plan_usable`.
[[nodiscard]] bool EngagementRequested(const ModeState& state, const ModeInputs& inputs);

}  // namespace safety
