// Decides who drives: a pure function of the previous mode and of the inputs of this cycle. It makes one step per
// cycle; cycles are counted and no time is read, so that a run is bit-for-bit repeatable.
//
//   Init ──► Standby ──► Active ◄──► Degraded ──► SafeStop ──► Standby        Fault from anywhere, back to Standby
//              ▲           │            │             │
//              └───────────┴────────────┴─────────────┘  override, request withdrawn
//
// Engagement needs a rising edge of the driver's request, seen in Standby, while all inputs are healthy, the vehicle is
// near the route and not at its end, nobody overrides and a first plan exists. An edge that comes while one of these is
// missing is lost: the driver has to ask again. (An edge in a cycle without a new state waits for the next state.)
//
// Degraded drives on while something is missing that is dispensable for a while: a new plan (the last one is
// continued), the state (it is predicted), the obstacles or the driver's request. A countdown gives the remaining cycles. When it ends, or at once
// if something indispensable is missing, SafeStop brings the vehicle to a stop along its path. When all causes are gone,
// plans are accepted and the driver still asks, the vehicle drives on, also from standstill for as long as it is held there.
//
// After many cycles without a sent command (the bus down or the process stopped) another node is assumed to drive;
// commands stay disabled until the driver asks again.
#pragma once

#include <cstdint>
#include <optional>

#include "bus/messages.hpp"
#include "safety/fault.hpp"

namespace safety {

using bus::Commands;
using bus::Drives;
using bus::Mode;

// Consecutive healthy cycles required to leave Init, to engage and to drive on from SafeStop.
inline constexpr int kHealthyCycles = 3;

struct ModeInputs {
  bool bus_up = false;
  bool state_new = false;  // a state set was completed for this cycle
  bool state_fresh = false;
  bool state_rejected = false;  // a frame of the state's messages was refused recently
  bool obstacles_fresh = false;
  bool request_fresh = false;
  bool engage = false;         // the last request
  bool released = false;       // engage was seen false since the previous cycle
  bool override_seen = false;  // brake or steering override since the previous cycle
  bool near_route = false;     // on the road, along it, fast enough
  bool plan_usable = false;    // there is a plan with a command for this cycle
  bool plan_new = false;       // a plan was accepted in this cycle
  bool stop_due = false;       // there is a clear stop now, but none that begins later
  int plan_left = 0;           // cycles after this one for which that plan has a command
  std::optional<bus::ModeCause> plan_fault =
      std::nullopt;             // why this cycle has no new plan, if it should have one
  std::int64_t route_left = 0;  // steps for which the route is long enough to plan on; 0 off the route
  bool standstill = false;      // according to a fresh state
  bool silent = false;          // no command was sent for many cycles
  bool internal_error = false;

  [[nodiscard]] bool Healthy() const;
};

// The most severe fault of the inputs: the reason for a stop or for a refused engagement.
[[nodiscard]] std::optional<Cause> InputFault(const ModeInputs& inputs);
// InputFault, or if there is none, why there is no new plan.
[[nodiscard]] std::optional<Cause> PresentFault(const ModeInputs& inputs);

struct ModeSettings {
  int degraded_cycles = 20;  // consecutive cycles in Degraded before the vehicle is stopped; ≥ 0
  int hold_cycles = 40;      // cycles for which SafeStop holds the vehicle at standstill; ≥ 0
};

struct ModeState {
  bus::Mode mode = bus::Mode::kInit;
  bus::Mode previous = bus::Mode::kInit;  // mode before the present one
  Cause cause = Cause::kStart;
  int healthy_cycles = 0;    // consecutive, up to kHealthyCycles
  bool armed = false;        // in Standby: engage was seen false, so that true is a rising edge
  int degraded_left = 0;     // in Degraded: further cycles before SafeStop
  int recovered_cycles = 0;  // in SafeStop: consecutive cycles without a cause to stop
  int standing_cycles = 0;   // in SafeStop: consecutive cycles at standstill, up to hold_cycles
};

[[nodiscard]] ModeState Next(const ModeState& state, const ModeInputs& inputs,
                             const ModeSettings& settings = {});

// True if the driver's request went from false to true; meaningful in Standby.
[[nodiscard]] bool RisingEdge(const ModeState& state, const ModeInputs& inputs);

// True if Next would engage given a plan: the cycle then has to make one. The result does not depend on
// `inputs.plan_usable`.
[[nodiscard]] bool EngagementRequested(const ModeState& state, const ModeInputs& inputs);

}  // namespace safety
