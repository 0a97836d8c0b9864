#include "control/mpc/timed_controller.hpp"

#include <utility>

namespace control {

TimedController::TimedController(std::unique_ptr<TrackingController> controller,
                                 const TimeReference& reference, const RoadEdges& edges)
    : controller_(std::move(controller)),
      reference_(&reference),
      edges_(edges),
      window_(static_cast<std::size_t>(controller_->horizon()) + 1),
      road_(window_.size()) {}

const Plan& TimedController::Step(const ControllerInput& input) {
  int k = static_cast<int>(ProgressAt(input.place).sample);
  reference_->Window(k, window_);
  for (RoadBounds& road : road_) road = edges_.At(reference_->ArcLength(k++));
  State z = input.z;
  z[kPsi] = UnwrapAngle(z[kPsi], window_.front()[kPsi]);
  return controller_->Step({.z = z,
                            .u_previous = input.u_previous,
                            .reference = window_,
                            .road = road_,
                            .obstacles = input.obstacles});
}

}  // namespace control
