// A controller driving the bicycle model along a reference, for tests.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "control/mpc/tracking_controller.hpp"
#include "control/road/time_reference.hpp"
#include "control/vehicle/single_track.hpp"
#include "tests/control/vehicle/rk4.hpp"

namespace control::testing {

inline constexpr double kStep = 0.05;  // [s]

// Points of a path at `speed` [m/s] from the origin in X direction, whose curvature after step k is curvature(k).
template <typename Curvature>
TimeReference PathOf(int count, double speed, Curvature&& curvature) {
  std::vector<Eigen::Vector2d> points{Eigen::Vector2d::Zero()};
  double heading = 0.0;
  for (int k = 0; k + 1 < count; ++k) {
    heading += curvature(k) * speed * kStep;
    points.push_back(points.back() + speed * kStep * Eigen::Vector2d(std::cos(heading), std::sin(heading)));
  }
  return {points, kStep};
}

inline TimeReference StraightPath(int count, double speed) {
  return PathOf(count, speed, [](int) { return 0.0; });
}

class ClosedLoop {
 public:
  ClosedLoop(TrackingController& controller, TimeReference reference)
      : controller_(&controller),
        reference_(std::move(reference)),
        window_(static_cast<std::size_t>(controller.horizon()) + 1),
        bounds_(window_.size()),
        z_(reference_[0]) {}

  State& z() { return z_; }
  [[nodiscard]] const Input& u() const { return u_; }
  [[nodiscard]] int k() const { return k_; }
  [[nodiscard]] const State& z_ref() const { return reference_[k_]; }
  std::vector<Obstacle>& obstacles() { return obstacles_; }
  RoadBounds& road() { return road_; }

  // The controller's answer to the present state; nothing moves.
  const Plan& Ask() {
    reference_.Window(k_, window_);
    return controller_->Step(Asked());
  }
  [[nodiscard]] TrackingInput Asked() {
    bounds_.assign(window_.size(), road_);
    return {.z = z_, .u_previous = u_, .reference = window_, .road = bounds_, .obstacles = obstacles_};
  }
  // Applies the plan's first input for one step.
  void Drive(const Plan& plan) {
    u_ = plan.u[0];
    z_ = Rk4(z_, kStep, 50, [&](const State& z) { return model_.Derivative(z, u_); });
    ++k_;
  }
  // Moves the vehicle exactly as the plan predicts.
  void DriveAsPredicted(const Plan& plan) {
    u_ = plan.u[0];
    z_ = plan.z[1];
    ++k_;
  }

 private:
  TrackingController* controller_;
  TimeReference reference_;
  SingleTrackModel model_{VehicleParameters{}};
  std::vector<State> window_;
  std::vector<RoadBounds> bounds_;
  std::vector<Obstacle> obstacles_;
  RoadBounds road_;
  State z_;
  Input u_ = Input::Zero();
  int k_ = 0;
};

}  // namespace control::testing
