// The interface of the paper's controllers, each of which tracks a given window of a reference.
#pragma once

#include <optional>
#include <span>

#include "control/mpc/constraint.hpp"
#include "control/mpc/controller.hpp"
#include "control/vehicle/types.hpp"

namespace control {

struct TrackingInput {
  State z = State::Zero();           // measured; ψ within π of the reference's
  Input u_previous = Input::Zero();  // input applied last, from which the rate limits of the first step count
  std::span<const State> reference;  // z_ref, steps 0..N: N + 1 states
  std::span<const RoadBounds> road;  // relative to the reference, steps 0..N
  std::span<const Obstacle> obstacles;
};

// The functions have the same meaning as those of Controller.
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
