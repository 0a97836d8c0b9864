// A controller whose every step is timed and passed to an observer.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "control/mpc/controller.hpp"

namespace tools {

struct StepObservation {
  const control::ControllerInput& input;
  const control::Plan& plan;
  const control::Controller& controller;
  double seconds;  // wall-clock time of the step
};

class ObservedController final : public control::Controller {
 public:
  ObservedController(std::unique_ptr<control::Controller> controller,
                     std::function<void(const StepObservation&)> observer)
      : controller_(std::move(controller)), observer_(std::move(observer)) {}

  [[nodiscard]] int horizon() const override { return controller_->horizon(); }
  [[nodiscard]] control::RouteProgress ProgressAt(const control::RoutePlace& place) const override {
    return controller_->ProgressAt(place);
  }
  [[nodiscard]] const control::Plan& Step(const control::ControllerInput& input) override;
  void Reset() override { controller_->Reset(); }
  [[nodiscard]] std::optional<control::ConstraintViolation> DiagnoseInfeasibility() const override {
    return controller_->DiagnoseInfeasibility();
  }
  [[nodiscard]] bool SetQpObserver(const control::QpObserver& observer) override {
    return controller_->SetQpObserver(observer);
  }

 private:
  std::unique_ptr<control::Controller> controller_;
  std::function<void(const StepObservation&)> observer_;
};

}  // namespace tools
