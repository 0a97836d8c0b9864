// What every controller takes and gives.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/mpc/vehicle_qp.hpp"
#include "control/qp/status.hpp"
#include "control/road/route_place.hpp"
#include "control/vehicle/types.hpp"

namespace control {

struct ControllerInput {
  State z = State::Zero();           // measured, ψ in any turn
  Input u_previous = Input::Zero();  // input last applied, against which the rate limits' first step is taken
  RoutePlace place;
  std::span<const Obstacle> obstacles;
  // Asked before an iteration that would improve the plan but is not needed, and within it: false ends it, and leaves the
  // plan before it. None: there is time.
  const TimeLeft* time_left = nullptr;
};

// Of the state, the input last applied and the obstacles.
[[nodiscard]] inline bool IsFinite(const ControllerInput& input) {
  return input.z.allFinite() && input.u_previous.allFinite() &&
         std::ranges::all_of(input.obstacles, [](const Obstacle& o) {
           return Eigen::Vector<double, 7>(o.X, o.Y, o.r_x, o.r_y, o.heading, o.velocity_X, o.velocity_Y)
               .allFinite();
         });
}

// The optimal trajectory of one step and what is to be known about how it came about.
struct Plan {
  SolverStatus status = SolverStatus::kNumericalFailure;
  int iterations = 0;
  std::vector<State> z;           // steps 0..N
  std::vector<Input> u;           // steps 0..N-1; meaningful only if status == kSolved
  double scheduling_error = 0.0;  // max_j |p_j − p̂_j| / e_j, realised against predicted in the previous step
  int active_trust_rows = 0;      // trust-region constraints at their bound
  double largest_slack = 0.0;     // in trust-region radii
  ConstraintViolation relaxation;  // largest slack of another soft constraint; amount 0: none
};

class Controller {
 public:
  virtual ~Controller() = default;
  [[nodiscard]] virtual int horizon() const = 0;  // N
  // Where its reference begins for a vehicle there, and for how many steps it can plan.
  [[nodiscard]] virtual RouteProgress ProgressAt(const RoutePlace& place) const = 0;
  // One control step. The plan belongs to the controller and stays until the next Step or Reset. Does not
  // allocate, but for an NMPC's.
  [[nodiscard]] virtual const Plan& Step(const ControllerInput& input) = 0;
  // Forgets the last plan: the next step schedules from the measured state alone.
  virtual void Reset() = 0;
  // After a step that was not solved: which hard constraint stands most in the way, and by how much. None where that
  // is not known. It solves, and does not allocate, but for an NMPC's.
  [[nodiscard]] virtual std::optional<ConstraintViolation> DiagnoseInfeasibility() const {
    return std::nullopt;
  }
  // Shows from now on every quadratic problem of a step before it is solved. False if the controller solves none.
  [[nodiscard]] virtual bool SetQpObserver(const QpObserver& /*observer*/) { return false; }
};

}  // namespace control
