// Makes the plan of a cycle and keeps the active plan with the stop behind it: state and obstacles are predicted to the time when the command
// acts, with the disturbances that the measured states show, and the controller solves. A plan that is late, unsolved
// or ruled out by the check does not replace the active plan. Nor does one behind which no stop is clear while the active plan
// still has one; if the active plan's next step has none either, its stop is due.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/time.hpp"
#include "bus/messages.hpp"
#include "control/estimation/disturbance_estimator.hpp"
#include "control/mpc/constraint.hpp"
#include "control/mpc/controller.hpp"
#include "control/mpc/plan_check.hpp"
#include "control/road/odometer.hpp"
#include "control/road/route_place.hpp"
#include "control/road/stop_path.hpp"
#include "control/vehicle/delay_compensator.hpp"
#include "control/vehicle/types.hpp"
#include "loop/active_plan.hpp"
#include "loop/inbox.hpp"
#include "loop/plan_verdict.hpp"
#include "safety/mode_machine.hpp"

namespace loop {

struct PlannerSettings {
  base::Time period{};         // t_s
  base::Time deadline{};       // age of a state beyond which an answer to it is late
  base::Time command_delay{};  // time from a command to its effect
  control::VehicleParameters vehicle;
  bool offset_free = false;        // whether disturbances are estimated and counted with
  double mu = 0.7;                 // assumed friction coefficient of the road
  double stop_deceleration = 3.0;  // deceleration of a stop that is not checked [m/s²]
};

// The request to the planner in a cycle.
enum class PlanRequest : std::uint8_t {
  kNone,     // the driver drives
  kFirst,    // commands are about to be enabled: nothing of an earlier drive may influence the plan
  kNext,     // another plan, without a new state from the predicted one
  kNoState,  // another plan would be due, but there is no fresh state, or no route left
};

struct Outcome {
  const control::Plan* solution = nullptr;  // this cycle's, accepted or not; null if no problem was solved
  bool accepted = false;
  bool late = false;                   // the deadline has passed
  bool stop_due = false;               // the vehicle must stop now, while there is a clear stop
  std::int64_t step = 0;               // step of the command: later than the snapshot's if the cycle was late
  base::Time solve_time{};             // time from StartStopwatch to the end of planning
  std::optional<safety::Cause> fault;  // why there is no new plan from a new state, if there should be one
  // First violation that the check predicts for the solution. An accepted one fails no earlier than the last plan.
  std::optional<control::ConstraintViolation> rejection;
  // Constraint that the solution could not meet, or the one that most obstructs a problem that was not solved.
  std::optional<control::ConstraintViolation> relaxation;
};

class Planner {
 public:
  // `stopwatch` returns the time since an arbitrary start, for durations only. `controller` and `check` must outlive
  // and `profile` the planner, too. Without a check (null) a plan is accepted if its values are finite.
  Planner(const PlannerSettings& settings, control::Controller& controller,
          const control::RoadProfile& profile, std::function<base::Time()> stopwatch,
          control::PlanCheck* check);

  Planner(const Planner&) = delete;  // time_left_ points to this object
  Planner& operator=(const Planner&) = delete;

  // Must be called when a cycle begins.
  void StartStopwatch() { start_ = stopwatch_(); }
  // Makes the plan of the cycle. `applied`: the last command, or while commands are disabled the measured inputs.
  [[nodiscard]] Outcome Plan(PlanRequest request, const Snapshot& known, const control::RoutePlace& place,
                             bool commanding, const control::Input& applied);

  // The input of a vehicle that stops, from the state of this cycle's Plan: along the path of the last accepted plan, and
  // as hard as it takes to touch nothing. If no stop is clear, it brakes its hardest.
  [[nodiscard]] control::Input StopInput(const Snapshot& known, const control::RoutePlace& place,
                                         const control::RouteMotion& motion, const control::Input& applied);

  [[nodiscard]] control::RouteProgress ProgressAt(const control::RoutePlace& place) const {
    return controller_->ProgressAt(place);
  }

  void Reconfigure(double stop_deceleration);

  // Drops the active plan, so that the next drive begins with a new one.
  void Forget() { active_.Clear(); }

  [[nodiscard]] const ActivePlan& active() const { return active_; }
  // The disturbance as estimated from the measured states, while commands are disabled too; none if not offset-free.
  [[nodiscard]] control::Disturbance disturbance() const {
    return estimator_ ? estimator_->disturbance() : control::Disturbance{};
  }
  // Bound of the friction coefficient that the tyres have shown; none if not offset-free.
  [[nodiscard]] double mu_limit() const { return estimator_ ? estimator_->mu_limit() : control::kNoLimit; }
  // Friction coefficient that plans count on.
  [[nodiscard]] double mu() const { return std::min(settings_.mu, mu_limit()); }
  // Number of plans refused since the start, and the reason of the last refusal.
  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  [[nodiscard]] bus::FaultCode last_refusal() const { return last_refusal_; }

 private:
  // Start of the plan: state and obstacles when the command of this cycle acts.
  struct Prediction {
    control::State z;
    std::span<const control::Obstacle> obstacles;
  };
  void Estimate(const Snapshot& known);
  [[nodiscard]] Prediction Predict(const Snapshot& known);
  [[nodiscard]] std::optional<control::ConstraintViolation> Unmet(const control::Plan& plan) const;
  void Accept(const Snapshot& known, const control::RoutePlace& place, const Present& present,
              Outcome& outcome);

  PlannerSettings settings_;
  control::Controller* controller_;
  std::function<base::Time()> stopwatch_;
  control::PlanCheck* check_;
  std::function<bool()> time_left_;  // whether another iteration may begin

  control::DelayCompensator delay_;
  std::optional<control::DisturbanceEstimator> estimator_;
  std::int64_t estimated_step_ = 0;  // step of the last state that the estimator took
  ActivePlan active_;
  control::StopPath stop_path_;  // along the last accepted plan
  bool slow_down_ = false;       // the stop behind the last plan must begin within half a second
  std::uint64_t refused_ = 0;
  bus::FaultCode last_refusal_ = bus::FaultCode::kNone;

  base::Time start_{};                        // start of the cycle, by the stopwatch
  std::vector<control::Obstacle> obstacles_;  // room for those of a Prediction
};

}  // namespace loop
