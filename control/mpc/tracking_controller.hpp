// What the paper's controllers take and give: each is handed the window of a reference that it tracks.
#pragma once

#include <optional>
#include <span>

#include "control/mpc/constraint.hpp"
#include "control/mpc/controller.hpp"
#include "control/vehicle/types.hpp"

namespace control {

struct TrackingInput {
  State z = State::Zero();           // measured; ψ within π of the reference's
  Input u_previous = Input::Zero();  // input last applied, against which the rate limits' first step is taken
  std::span<const State> reference;  // z_ref, steps 0..N: N + 1 states
  RoadBounds road;                   // relative to the reference
  std::span<const Obstacle> obstacles;
};

// Its functions are those of Controller.
class TrackingController {
 public:
  virtual ~TrackingController() = default;
  [[nodiscard]] virtual int horizon() const = 0;
  [[nodiscard]] virtual const Plan& Step(const TrackingInput& input) = 0;
  virtual void Reset() = 0;
  [[nodiscard]] virtual std::optional<ConstraintViolation> DiagnoseInfeasibility() const {
    return std::nullopt;
  }
  [[nodiscard]] virtual bool SetQpObserver(const QpObserver& /*observer*/) { return false; }
};

}  // namespace control
