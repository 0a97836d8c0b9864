// What happened in a control cycle, for the bus, the log and the service manager.
#pragma once

#include <cstdint>
#include <optional>

#include "control/constraint.hpp"
#include "control/types.hpp"
#include "daemon/faulty_message.hpp"
#include "daemon/mode_machine.hpp"
#include "daemon/time.hpp"
#include "dbc/messages.hpp"

namespace lpvmpcd {

struct CycleReport {
  Mode mode = Mode::kInit;
  Mode previous_mode = Mode::kInit;  // another one: the mode changed in this cycle
  Cause cause = Cause::kStart;       // of the present mode
  dbc::FaultCode fault = dbc::FaultCode::kNone;
  dbc::SolverStatus solver = dbc::SolverStatus::kNone;
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
  std::optional<FaultyMessage> faulty_message = std::nullopt;
  Time countdown = Time::max();  // until the vehicle is stopped, as things are; max: not driving
  int plan_age = -1;             // cycles, -1 without a plan
  int route_index = -1;          // point of the reference, -1 off the route
  bool limited = false;          // the limiter changed the command
  control::Input command = control::Input::Zero();
  Time step_time{};      // by the stopwatch
  Time cycle_latency{};  // of the last state that was answered: its arrival to both commands sent
  std::uint64_t cycles = 0;
  std::uint64_t deadline_misses = 0;
  std::uint64_t plans_refused = 0;                      // not solved, late, or not acceptable
  dbc::FaultCode last_refusal = dbc::FaultCode::kNone;  // why the last of them was
};

}  // namespace lpvmpcd
