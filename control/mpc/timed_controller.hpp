// One of the paper's controllers, which tracks its reference by time: sample k is where the vehicle should be k·t_s
// after the start of the route.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "control/mpc/controller.hpp"
#include "control/mpc/tracking_controller.hpp"
#include "control/road/road_edges.hpp"
#include "control/road/time_reference.hpp"

namespace control {

class TimedController final : public Controller {
 public:
  // `reference` must outlive the controller; `edges` are relative to the reference.
  TimedController(std::unique_ptr<TrackingController> controller, const TimeReference& reference,
                  const RoadEdges& edges);

  [[nodiscard]] int horizon() const override { return controller_->horizon(); }
  [[nodiscard]] RouteProgress ProgressAt(const RoutePlace& place) const override {
    return ProgressByTime(place, horizon());
  }
  [[nodiscard]] const Plan& Step(const ControllerInput& input) override;
  void Reset() override { controller_->Reset(); }
  [[nodiscard]] std::optional<ConstraintViolation> DiagnoseInfeasibility() const override {
    return controller_->DiagnoseInfeasibility();
  }
  [[nodiscard]] bool SetQpObserver(const QpObserver& observer) override {
    return controller_->SetQpObserver(observer);
  }

 private:
  std::unique_ptr<TrackingController> controller_;
  const TimeReference* reference_;
  RoadEdges edges_;
  std::vector<State> window_;
  std::vector<RoadBounds> road_;  // beside the window's samples
};

}  // namespace control
