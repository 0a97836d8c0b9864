#include "control/mpc/timed_controller.hpp"

#include <utility>

namespace control {

TimedController::TimedController(std::unique_ptr<TrackingController> controller,
                                 const TimeReference& reference, const RoadBounds& road)
    : controller_(std::move(controller)),
      reference_(&reference),
      road_(road),
      window_(static_cast<std::size_t>(controller_->horizon()) + 1) {}

const Plan& TimedController::Step(const ControllerInput& input) {
  reference_->Window(static_cast<int>(ProgressAt(input.place).sample), window_);
  State z = input.z;
  z[kPsi] = UnwrapAngle(z[kPsi], window_.front()[kPsi]);
  return controller_->Step({.z = z,
                            .u_previous = input.u_previous,
                            .reference = window_,
                            .road = road_,
                            .obstacles = input.obstacles});
}

}  // namespace control
