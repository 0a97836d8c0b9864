// What happened in a control cycle, for the bus, the log and the service manager.
#pragma once

#include <cstdint>
#include <optional>

#include "base/time.hpp"
#include "bus/messages.hpp"
#include "control/mpc/constraint.hpp"
#include "control/vehicle/types.hpp"
#include "safety/faulty_message.hpp"
#include "safety/mode_machine.hpp"

namespace loop {

struct CycleReport {
  bus::Mode mode = bus::Mode::kInit;
  bus::Mode previous_mode = bus::Mode::kInit;   // another one: the mode changed in this cycle
  safety::Cause cause = safety::Cause::kStart;  // of the present mode
  bus::FaultCode fault = bus::FaultCode::kNone;
  bus::SolverStatus solver = bus::SolverStatus::kNone;
  int iterations = 0;  // of the solver
  bool plan_accepted = false;
  // What the plan of this cycle could not meet and by how much, or of an unsolved problem what stands most in its way.
  std::optional<control::ConstraintViolation> relaxation = std::nullopt;
  // What would go wrong with it. Of an accepted plan: no less, and no later, than with the last one.
  std::optional<control::ConstraintViolation> rejection = std::nullopt;
  // The one of both that is told of: what the check found weighs more than what the plan says of itself.
  [[nodiscard]] const std::optional<control::ConstraintViolation>& unmet() const {
    return rejection ? rejection : relaxation;
  }
  bool engagement_refused = false;  // the driver asked in this cycle and did not get it
  std::optional<safety::FaultyMessage> faulty_message = std::nullopt;
  base::Time countdown = base::Time::max();  // until the vehicle is stopped, as things are; max: not driving
  int plan_age = -1;                         // cycles, -1 without a plan
  int route_index = -1;                      // point of the reference, -1 off the route
  bool limited = false;                      // the limiter changed the command
  control::Input command = control::Input::Zero();
  base::Time step_time{};      // by the stopwatch
  base::Time cycle_latency{};  // of the last state that was answered: its arrival to both commands sent
  std::uint64_t cycles = 0;
  std::uint64_t deadline_misses = 0;
  std::uint64_t plans_refused = 0;                      // not solved, late, or not acceptable
  bus::FaultCode last_refusal = bus::FaultCode::kNone;  // why the last of them was
};

}  // namespace loop
