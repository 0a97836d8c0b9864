// The command of a cycle, depending on the mode: from the active plan, from the stop behind it, or the measured
// inputs. It always passes the limiter. The last applied command is stored.
#pragma once

#include <cstdint>
#include <span>

#include "bus/messages.hpp"
#include "control/vehicle/types.hpp"
#include "loop/active_plan.hpp"
#include "loop/inbox.hpp"
#include "safety/command_limiter.hpp"

namespace loop {

class CommandSource {
 public:
  explicit CommandSource(const safety::CommandLimits& limits) : limiter_(limits) {}

  // The input that acts on the vehicle: the last command or, while commands are disabled, the measured inputs.
  [[nodiscard]] control::Input Applied(const VehicleState& state, bool commanding) const;

  // The command for `step`, which the plan must cover if the mode drives. `stop`: the input if it is SafeStop. No command if
  // the limiter refuses it.
  [[nodiscard]] safety::LimitResult Command(bus::Mode mode, std::int64_t step, const ActivePlan& plan,
                                            const control::Input& stop, const VehicleState& state,
                                            const control::Input& applied) const;
  // The measured inputs. They are sent while commands are disabled, so that enabling commands causes no jump.
  [[nodiscard]] safety::LimitResult Measured(const VehicleState& state) const;

  // Must be called with each command that is sent enabled.
  void Apply(const safety::LimitedCommand& command) { applied_ = command.u(); }

 private:
  safety::CommandLimiter limiter_;
  control::Input applied_ = control::Input::Zero();
};

}  // namespace loop
