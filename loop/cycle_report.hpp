// The report of a control cycle, for the bus, the log and the service manager.
#pragma once

#include <cstdint>
#include <optional>

#include "base/time.hpp"
#include "bus/messages.hpp"
#include "control/mpc/constraint.hpp"
#include "control/vehicle/disturbance.hpp"
#include "control/vehicle/types.hpp"
#include "safety/faulty_message.hpp"
#include "safety/mode_machine.hpp"

namespace loop {

struct CycleReport {
  bus::Mode mode = bus::Mode::kInit;
  bus::Mode previous_mode = bus::Mode::kInit;   // differs if the mode changed in this cycle
  safety::Cause cause = safety::Cause::kStart;  // cause of the present mode
  bus::FaultCode fault = bus::FaultCode::kNone;
  bus::SolverStatus solver = bus::SolverStatus::kNone;
  int iterations = 0;  // solver iterations
  bool plan_accepted = false;
  // Constraint that the plan of this cycle could not meet, or the one that most obstructs an unsolved problem.
  std::optional<control::ConstraintViolation> relaxation = std::nullopt;
  // First violation that the check predicts for the plan. An accepted plan fails no earlier than the last one would.
  std::optional<control::ConstraintViolation> rejection = std::nullopt;
  // The violation to be reported: that of the check takes precedence over the plan's own.
  [[nodiscard]] const std::optional<control::ConstraintViolation>& unmet() const {
    return rejection ? rejection : relaxation;
  }
  control::Disturbance disturbance = {};  // as estimated from the states
  bus::ManoeuvreStatus manoeuvre = {};    // decided in this cycle, whether its plan is accepted or not
  double mu = 0.0;                        // friction coefficient that plans count on
  bool engagement_refused = false;        // the driver's request of this cycle was not granted
  std::optional<safety::FaultyMessage> faulty_message = std::nullopt;
  base::Time countdown = base::Time::max();  // time until the stop if nothing changes; max: not driving
  int plan_age = -1;                         // cycles; -1 without a plan or with commands disabled
  int route_index = -1;                      // point of the reference; -1 off the route
  bool limited = false;                      // the limiter changed the command
  control::Input command = control::Input::Zero();
  base::Time step_time{};      // time of the whole control step, by the stopwatch
  base::Time cycle_latency{};  // last cycle started by a state: its arrival to both commands sent
  std::uint64_t cycles = 0;
  std::uint64_t deadline_misses = 0;
  std::uint64_t plans_refused = 0;                      // not solved, late, or not acceptable
  bus::FaultCode last_refusal = bus::FaultCode::kNone;  // reason of the last one
};

}  // namespace loop
