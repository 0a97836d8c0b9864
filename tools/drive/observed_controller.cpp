#include "tools/drive/observed_controller.hpp"

#include <chrono>

namespace tools {

const control::Plan& ObservedController::Step(const control::ControllerInput& input) {
  const auto start = std::chrono::steady_clock::now();
  const control::Plan& plan = controller_->Step(input);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  observer_({.input = input, .plan = plan, .controller = *controller_, .seconds = elapsed.count()});
  return plan;
}

}  // namespace tools
