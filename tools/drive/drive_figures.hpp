// What a drive shows of its controller beyond the vehicle's summary: time of each step, cost, smoothness, and the first
// step that was not solved with what stood in its way.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/mpc/controller.hpp"
#include "sim/summary.hpp"
#include "tools/drive/closed_loop.hpp"

namespace tools {

// Q and R of the cost by which drives are compared.
struct CostWeights {
  control::State Q;
  control::Input R;
  // Whether being ahead of the reference or behind it counts. If not, z_ref is the point of the reference beside the
  // vehicle: for controllers whose reference goes by progress.
  bool along = true;
};

struct FirstFailure {
  int step = 0;  // control steps before it
  control::SolverStatus status = control::SolverStatus::kInfeasible;
  std::optional<control::ConstraintViolation> violation;
};

struct DriveFigures {
  sim::Summary summary;
  std::vector<double> step_seconds;           // of wall clock, one for each control step
  std::optional<FirstFailure> first_failure;  // none: every step was solved
  double cost = 0.0;               // Σ |z − z_ref|²_Q + |u|²_R of what was measured and applied
  double rms_steering_rate = 0.0;  // [rad/s]
  double rms_jerk = 0.0;           // [m/s³]

  [[nodiscard]] bool engaged() const { return !step_seconds.empty(); }  // any control step was taken
};

// Drives as DriveClosedLoop does, whose errors are its own.
[[nodiscard]] DriveFigures MeasureDrive(const sim::Scenario& scenario, const loop::Config& config,
                                        const config::RouteFile& route, const CostWeights& weights,
                                        const std::function<void(const can::Frame&)>& frame = nullptr);

// "step 134, infeasible: obstacle 1 at i = 8, short of 31.0 mm"
[[nodiscard]] std::string ToText(const FirstFailure& failure);

}  // namespace tools
