// The command of a cycle, by mode: from the active plan, from the stop along the route, or what the vehicle does by itself;
// always through the limiter. Keeps what was applied last.
#pragma once

#include <cstdint>
#include <span>

#include "bus/messages.hpp"
#include "control/road/odometer.hpp"
#include "control/road/path_stop.hpp"
#include "control/vehicle/types.hpp"
#include "loop/active_plan.hpp"
#include "loop/inbox.hpp"
#include "safety/command_limiter.hpp"

namespace loop {

class CommandSource {
 public:
  // `stop_deceleration` of SafeStop [m/s²].
  CommandSource(const safety::CommandLimits& limits, const control::PathStop& stop, double stop_deceleration)
      : limiter_(limits), stop_(stop), stop_deceleration_(stop_deceleration) {}

  // While commands are not enabled, what the vehicle does by itself counts as applied.
  void Observe(const VehicleState& state, bool commanding);

  // For `step`, which the plan must cover if the mode drives. Without a command if the limiter refuses it.
  [[nodiscard]] safety::LimitResult Command(bus::Mode mode, std::int64_t step, const ActivePlan& plan,
                                            const control::RouteMotion& motion,
                                            const VehicleState& state) const;
  // What the vehicle does: sent while commands are not enabled, so that enabling them later is no jump.
  [[nodiscard]] safety::LimitResult Measured(const VehicleState& state) const;

  // The stop along the route ends as far beside it as this plan does: N + 1 states that begin where the vehicle is.
  void Follow(std::span<const control::State> plan, const control::RouteMotion& motion) {
    stop_offset_ = stop_.OffsetOf(plan, motion);
  }

  // This command was sent, enabled.
  void Apply(const safety::LimitedCommand& command) { applied_ = command.u(); }
  [[nodiscard]] const control::Input& applied() const { return applied_; }

  void Reconfigure(double stop_deceleration) { stop_deceleration_ = stop_deceleration; }

 private:
  safety::CommandLimiter limiter_;
  control::PathStop stop_;
  double stop_deceleration_;
  double stop_offset_ = 0.0;  // of the path of the stop, left of the route [m]
  control::Input applied_ = control::Input::Zero();
};

}  // namespace loop
