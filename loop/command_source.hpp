// The command of a cycle, depending on the mode: from the active plan, from the stop along the route, or the measured
// inputs. It always passes the limiter. The last applied command is stored.
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
  // `stop_deceleration`: deceleration in SafeStop [m/s²].
  CommandSource(const safety::CommandLimits& limits, const control::PathStop& stop, double stop_deceleration)
      : limiter_(limits), stop_(stop), stop_deceleration_(stop_deceleration) {}

  // The input that acts on the vehicle: the last command or, while commands are disabled, the measured inputs.
  [[nodiscard]] control::Input Applied(const VehicleState& state, bool commanding) const;

  // The command for `step`, which the plan must cover if the mode drives. No command if the limiter refuses it.
  [[nodiscard]] safety::LimitResult Command(bus::Mode mode, std::int64_t step, const ActivePlan& plan,
                                            const control::RouteMotion& motion, const VehicleState& state,
                                            const control::Input& applied) const;
  // The measured inputs. They are sent while commands are disabled, so that enabling commands causes no jump.
  [[nodiscard]] safety::LimitResult Measured(const VehicleState& state) const;

  // A later stop runs beside the route at the offset at which `plan` ends; its N + 1 states begin at the vehicle.
  void PlanStop(std::span<const control::State> plan, const control::RouteMotion& motion) {
    stop_offset_ = stop_.OffsetOf(plan, motion);
  }

  // Must be called with each command that is sent enabled.
  void Apply(const safety::LimitedCommand& command) { applied_ = command.u(); }

  void Reconfigure(double stop_deceleration) { stop_deceleration_ = stop_deceleration; }

 private:
  safety::CommandLimiter limiter_;
  control::PathStop stop_;
  double stop_deceleration_;
  double stop_offset_ = 0.0;  // offset of the stop's path, left of the route [m]
  control::Input applied_ = control::Input::Zero();
};

}  // namespace loop
