// Makes the plan of a cycle and keeps the active one: state and obstacles are predicted to the time when the command acts,
// the controller solves, and a plan that is late, unsolved or ruled out by the check does not replace the active plan.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "base/time.hpp"
#include "bus/messages.hpp"
#include "control/mpc/constraint.hpp"
#include "control/mpc/controller.hpp"
#include "control/mpc/plan_check.hpp"
#include "control/road/route_place.hpp"
#include "control/vehicle/delay_compensator.hpp"
#include "control/vehicle/types.hpp"
#include "loop/active_plan.hpp"
#include "loop/inbox.hpp"
#include "safety/mode_machine.hpp"

namespace loop {

struct PlannerSettings {
  base::Time period{};         // t_s
  base::Time deadline{};       // age of a state at which an answer to it comes too late
  base::Time command_delay{};  // from a command to its effect
  control::VehicleParameters vehicle;
};

// What is asked of the planner in a cycle.
enum class PlanRequest : std::uint8_t {
  kNone,     // the driver drives
  kFirst,    // commands are about to be enabled: nothing of an earlier drive may have a say in it
  kNext,     // another plan, if there is a state to plan from
  kNoState,  // another plan would be due, but there is no new state, or no route left
};

struct Outcome {
  const control::Plan* solution = nullptr;  // of this cycle, accepted or not; null if no problem was solved
  bool accepted = false;
  bool late = false;        // the deadline has passed
  std::int64_t step = 0;    // that the command is for: later than the snapshot's if the cycle took that long
  base::Time solve_time{};  // of the whole planning
  std::optional<safety::Cause> fault;  // why there is no new plan, if there should be one
  // What would go wrong with the solution. An accepted one goes wrong no earlier than the plan before it.
  std::optional<control::ConstraintViolation> rejection;
  // What the solution could not meet, or, without one, what stands most in its way.
  std::optional<control::ConstraintViolation> relaxation;
};

class Planner {
 public:
  // `stopwatch` answers with a time since any start, for durations only. `controller` and `check` must outlive the planner. Without a check (null) a plan is accepted if its values are finite.
  Planner(const PlannerSettings& settings, control::Controller& controller,
          std::function<base::Time()> stopwatch, control::PlanCheck* check);

  Planner(const Planner&) = delete;  // the controller's question for time left points into it
  Planner& operator=(const Planner&) = delete;

  // A cycle begins.
  void Start() { start_ = stopwatch_(); }
  // The plan of the cycle. `applied`: the last command, or while others drive what they do.
  [[nodiscard]] Outcome Plan(PlanRequest request, const Snapshot& known, const control::RoutePlace& place,
                             bool commanding, const control::Input& applied);

  [[nodiscard]] control::RouteProgress ProgressAt(const control::RoutePlace& place) const {
    return controller_->ProgressAt(place);
  }

  // Drops the active plan: the next drive begins with a plan of its own.
  void Forget() { active_.Drop(); }

  [[nodiscard]] const ActivePlan& active() const { return active_; }
  // Plans that were not accepted since the start, and why the last of them was not.
  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  [[nodiscard]] bus::FaultCode last_refusal() const { return last_refusal_; }

 private:
  [[nodiscard]] const control::Plan& Solve(const Snapshot& known, const control::RoutePlace& place,
                                           const control::Input& applied);
  [[nodiscard]] std::optional<control::ConstraintViolation> Unmet(const control::Plan& plan) const;
  void Accept(const Snapshot& known, Outcome& outcome);

  PlannerSettings settings_;
  control::Controller* controller_;
  std::function<base::Time()> stopwatch_;
  control::PlanCheck* check_;
  std::function<bool()> time_left_;  // for another iteration

  control::DelayCompensator delay_;
  ActivePlan active_;
  std::uint64_t refused_ = 0;
  bus::FaultCode last_refusal_ = bus::FaultCode::kNone;

  base::Time start_{};                         // of the cycle, by the stopwatch
  control::State z_ = control::State::Zero();  // when the command of this cycle acts
  std::vector<control::Obstacle> obstacles_;   // then
};

}  // namespace loop
