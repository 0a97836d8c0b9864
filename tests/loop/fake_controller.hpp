// A controller that does as a test says, and the road that it drives on.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "control/mpc/controller.hpp"

namespace loop {

// Answers as it is told to. Its plan's inputs are recognisable: δ_i = 0.01 (i + 1), a_i = −0.1 (i + 1).
class FakeController : public control::Controller {
 public:
  static constexpr int kHorizon = 4;
  FakeController() {
    plan_.z.resize(kHorizon + 1, control::State::Zero());
    for (int i = 0; i < kHorizon; ++i) {
      plan_.u.emplace_back(0.01 * (i + 1), -0.1 * (i + 1));
    }
  }
  void Plan(const control::Input& u) { std::ranges::fill(plan_.u, u); }  // from now on, this in every step
  int horizon() const override { return kHorizon; }
  const control::Plan& Step(const control::ControllerInput& input) override {
    ++steps;
    z = input.z;
    u_previous = input.u_previous;
    obstacles = input.obstacles.size();
    first_reference = input.reference.front();
    reference_size = input.reference.size();
    plan_.status = status;
    plan_.iterations = 7;
    if (poison_input) plan_.u[3][control::kDelta] = std::numeric_limits<double>::quiet_NaN();
    plan_.z[2][control::kX] = poison ? std::numeric_limits<double>::quiet_NaN() : 12.5;
    return plan_;
  }
  void Reset() override { ++resets; }

  control::SolverStatus status = control::SolverStatus::kSolved;
  bool poison = false;
  bool poison_input = false;  // the last one
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

// 10 m/s along X.
inline std::vector<Eigen::Vector2d> StraightRoute() {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 200; ++i) {
    points.emplace_back(0.5 * i, 0.0);
  }
  return points;
}

}  // namespace loop
