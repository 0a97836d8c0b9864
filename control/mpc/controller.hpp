// The interface of every controller: its input, its plan, its control step.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/mpc/vehicle_qp.hpp"
#include "control/qp/status.hpp"
#include "control/road/lateral_path.hpp"
#include "control/road/route_place.hpp"
#include "control/traffic/manoeuvre_status.hpp"
#include "control/vehicle/disturbance.hpp"
#include "control/vehicle/types.hpp"

namespace control {

struct ControllerInput {
  State z = State::Zero();           // measured; ψ may include full turns
  Input u_previous = Input::Zero();  // input applied last, from which the rate limits of the first step count
  RoutePlace place;
  std::span<const Obstacle> obstacles;
  Disturbance disturbance = {};  // taken to last; the paper's controllers ignore it
  double mu_limit = kNoLimit;    // second bound of the friction coefficient; ignored likewise
  bool slow_down = false;  // the vehicle should brake comfortably, unless it overtakes; ignored likewise
  // Called before and within each iteration that could improve the plan but is not required. False ends that iteration
  // and keeps the plan before it. Null: time is unlimited.
  const TimeLeft* time_left = nullptr;
};

// True if the state, the input applied last and all obstacles are finite.
[[nodiscard]] inline bool IsFinite(const ControllerInput& input) {
  return input.z.allFinite() && input.u_previous.allFinite() &&
         std::ranges::all_of(input.obstacles, [](const Obstacle& o) {
           return Eigen::Vector<double, 7>(o.X, o.Y, o.r_x, o.r_y, o.heading, o.velocity_X, o.velocity_Y)
               .allFinite();
         });
}

// The optimal trajectory of one step, with diagnostics of its computation.
struct Plan {
  SolverStatus status = SolverStatus::kNumericalFailure;
  int iterations = 0;
  std::vector<State> z;            // steps 0..N
  std::vector<Input> u;            // steps 0..N-1; meaningful only if status == kSolved
  double scheduling_error = 0.0;   // max_j |p_j − p̂_j| / e_j, p̂ as predicted in the previous step
  int active_trust_rows = 0;       // number of trust-region constraints at their bound
  double largest_slack = 0.0;      // in trust-region radii
  ConstraintViolation relaxation;  // largest slack of any other soft constraint; amount 0: none
  LateralPath beyond;              // the path that leads on beyond step N; it need not exist
  // What was decided about the things on the road; none if the controller does not decide.
  std::optional<ManoeuvreStatus> manoeuvre = std::nullopt;
};

class Controller {
 public:
  virtual ~Controller() = default;
  [[nodiscard]] virtual int horizon() const = 0;  // N
  // Where the reference begins for a vehicle at this place, and for how many steps the controller can plan.
  [[nodiscard]] virtual RouteProgress ProgressAt(const RoutePlace& place) const = 0;
  // Performs one control step. The plan belongs to the controller and is valid until the next Step or Reset. Only an
  // NMPC allocates here.
  [[nodiscard]] virtual const Plan& Step(const ControllerInput& input) = 0;
  // Forgets the last plan: the next step schedules from the measured state alone.
  virtual void Reset() = 0;
  // After a step that was not solved: the hard constraint that needs the largest relaxation, and the amount; nullopt if
  // that is not known. This may solve another problem; only an NMPC allocates here.
  [[nodiscard]] virtual std::optional<ConstraintViolation> DiagnoseInfeasibility() const {
    return std::nullopt;
  }
  // From now on, shows the observer every QP of a step before it is solved. False if the controller solves no QPs.
  [[nodiscard]] virtual bool SetQpObserver(const QpObserver& /*observer*/) { return false; }
};

}  // namespace control
