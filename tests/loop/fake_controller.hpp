// A controller scripted by a test, and the road that it drives on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "control/mpc/timed_controller.hpp"
#include "control/road/route.hpp"

namespace loop {

// Answers as set by its members. The inputs of its plan are recognisable: δ_i = 0.01 (i + 1), a_i = −0.1 (i + 1).
class FakeController : public control::TrackingController {
 public:
  static constexpr int kHorizon = 4;
  FakeController() {
    plan_.z.resize(kHorizon + 1, control::State::Zero());
    for (int i = 0; i < kHorizon; ++i) {
      plan_.u.emplace_back(0.01 * (i + 1), -0.1 * (i + 1));
    }
  }
  void Plan(const control::Input& u) { std::ranges::fill(plan_.u, u); }  // from now on, `u` in every step
  int horizon() const override { return kHorizon; }
  const control::Plan& Step(const control::TrackingInput& input) override {
    ++steps;
    z = input.z;
    u_previous = input.u_previous;
    obstacles = input.obstacles.size();
    first_reference = input.reference.front();
    reference_size = input.reference.size();
    plan_.status = status;
    plan_.iterations = 7;
    plan_.manoeuvre = manoeuvre;
    if (poison_input) plan_.u[3][control::kDelta] = std::numeric_limits<double>::quiet_NaN();
    // Straight on from the state, whatever the inputs are.
    for (std::size_t i = 0; i < plan_.z.size(); ++i) {
      plan_.z[i] = z;
      plan_.z[i].head<2>() += 0.05 * static_cast<double>(i) * z[control::kUpsilon] *
                              Eigen::Vector2d(std::cos(z[control::kPsi]), std::sin(z[control::kPsi]));
    }
    if (poison) plan_.z[2][control::kX] = std::numeric_limits<double>::quiet_NaN();
    return plan_;
  }
  void Reset() override { ++resets; }

  control::SolverStatus status = control::SolverStatus::kSolved;
  std::optional<control::ManoeuvreStatus> manoeuvre;
  bool poison = false;
  bool poison_input = false;  // puts a NaN into the last input
  int steps = 0;
  int resets = 0;
  control::State z;
  control::Input u_previous;
  std::size_t obstacles = 0;
  control::State first_reference;
  std::size_t reference_size = 0;

 private:
  control::Plan plan_;
};

// Forwards to a controller that the test owns.
class Forwarding : public control::TrackingController {
 public:
  explicit Forwarding(control::TrackingController& controller) : controller_(&controller) {}
  int horizon() const override { return controller_->horizon(); }
  const control::Plan& Step(const control::TrackingInput& input) override { return controller_->Step(input); }
  void Reset() override { controller_->Reset(); }

 private:
  control::TrackingController* controller_;
};

// The controller on a reference that begins beside the vehicle, as that of lpv-affine does.
class ProgressController : public control::Controller {
 public:
  ProgressController(FakeController& controller, const control::TimeReference& reference)
      : controller_(&controller), reference_(&reference) {}
  int horizon() const override { return controller_->horizon(); }
  control::RouteProgress ProgressAt(const control::RoutePlace& place) const override {
    return control::ProgressByPlace(place);
  }
  const control::Plan& Step(const control::ControllerInput& input) override {
    std::array<control::State, FakeController::kHorizon + 1> window;
    reference_->Window(static_cast<int>(ProgressAt(input.place).sample), window);
    return controller_->Step({.z = input.z,
                              .u_previous = input.u_previous,
                              .reference = window,
                              .road = {},
                              .obstacles = input.obstacles});
  }
  void Reset() override { controller_->Reset(); }

 private:
  FakeController* controller_;
  const control::TimeReference* reference_;
};

// A straight path along X at 10 m/s.
inline std::vector<Eigen::Vector2d> StraightRoute() {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 200; ++i) {
    points.emplace_back(0.5 * i, 0.0);
  }
  return points;
}
// The same as a path.
inline control::Route StraightOn() {
  const std::vector<control::RoutePiece> pieces{{.length = 99.5}};
  return control::Route::FromPieces({}, 10.0, pieces);
}

}  // namespace loop
