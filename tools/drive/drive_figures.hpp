// Figures of a drive's controller beyond the vehicle's summary: time of each step, cost, smoothness, and the first
// unsolved step with the constraint that it violates.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/mpc/constraint.hpp"
#include "control/mpc/controller.hpp"
#include "sim/summary.hpp"
#include "tools/drive/closed_loop.hpp"

namespace tools {

// Q and R of the cost that compares drives.
struct CostWeights {
  control::State Q;
  control::Input R;
  // Whether being ahead of or behind the reference counts. If not, z_ref is the reference's point beside the vehicle,
  // for controllers whose reference depends on progress.
  bool along = true;
};

struct FirstFailure {
  int step = 0;  // number of control steps before it
  control::SolverStatus status = control::SolverStatus::kInfeasible;
  std::optional<control::ConstraintViolation> violation;
};

struct DriveFigures {
  sim::Summary summary;
  std::vector<double> step_seconds;           // wall-clock time of each control step
  std::optional<FirstFailure> first_failure;  // none: every step was solved
  double cost = 0.0;               // Σ |z − z_ref|²_Q + |u|²_R of measured states and applied inputs
  double rms_steering_rate = 0.0;  // [rad/s]
  double rms_jerk = 0.0;           // [m/s³]

  [[nodiscard]] bool engaged() const { return !step_seconds.empty(); }  // at least one control step was taken
};

// Drives as DriveClosedLoop does and throws the same errors.
[[nodiscard]] DriveFigures MeasureDrive(const sim::Scenario& scenario, const loop::Config& config,
                                        const config::RouteFile& route, const CostWeights& weights,
                                        const std::function<void(const can::Frame&)>& frame = nullptr);

// "step 134, infeasible: obstacle 1 at i = 8, short of 31.0 mm"
[[nodiscard]] std::string ToText(const FirstFailure& failure);

}  // namespace tools
