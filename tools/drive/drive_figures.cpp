#include "tools/drive/drive_figures.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>
#include <vector>

#include "control/road/projection.hpp"
#include "control/road/time_reference.hpp"
#include "control/vehicle/geometry.hpp"
#include "loop/violation_text.hpp"

namespace tools {
namespace {

// Accumulates the figures of a drive. The applied input is observed as u_{k−1} of the next step.
class Meter {
 public:
  Meter(const CostWeights& weights, double t_s, const control::Route& route)
      : weights_(weights), t_s_(t_s), reference_(control::SampleRoute(route, t_s), t_s) {}

  void Take(const StepObservation& observed) {
    const control::Input& u = observed.input.u_previous;
    if (!figures_.step_seconds.empty()) {
      const control::Input rate = (u - u_last_) / t_s_;
      squared_rate_ += rate.cwiseAbs2();
      figures_.cost += weights_.R.dot(u.cwiseAbs2());
    }
    u_last_ = u;
    window_.resize(static_cast<std::size_t>(observed.controller.horizon()) + 1);
    reference_.Window(static_cast<int>(observed.controller.ProgressAt(observed.input.place).sample), window_);
    control::State z = observed.input.z;
    z[control::kPsi] = control::UnwrapAngle(z[control::kPsi], window_.front()[control::kPsi]);
    const control::State error =
        z - (weights_.along ? window_.front() : control::InterpolateBeside(control::Position(z), window_));
    figures_.cost += weights_.Q.dot(error.cwiseAbs2());
    if (observed.plan.status != control::SolverStatus::kSolved && !figures_.first_failure) {
      figures_.first_failure = {.step = static_cast<int>(figures_.step_seconds.size()),
                                .status = observed.plan.status,
                                .violation = observed.controller.DiagnoseInfeasibility()};
    }
    figures_.step_seconds.push_back(observed.seconds);
  }

  [[nodiscard]] DriveFigures Result(const sim::Summary& summary) const {
    DriveFigures figures = figures_;
    figures.summary = summary;
    const auto rates = static_cast<double>(std::max<std::size_t>(figures.step_seconds.size(), 2) - 1);
    figures.rms_steering_rate = std::sqrt(squared_rate_[control::kDelta] / rates);
    figures.rms_jerk = std::sqrt(squared_rate_[control::kAcceleration] / rates);
    return figures;
  }

 private:
  CostWeights weights_;
  double t_s_;
  control::TimeReference reference_;
  std::vector<control::State> window_;
  control::Input u_last_ = control::Input::Zero();
  control::Input squared_rate_ = control::Input::Zero();
  DriveFigures figures_;
};

const char* NameOf(control::SolverStatus status) {
  switch (status) {
    case control::SolverStatus::kSolved:
      return "solved";
    case control::SolverStatus::kInfeasible:
      return "infeasible";
    case control::SolverStatus::kIterationLimit:
      return "iteration limit";
    case control::SolverStatus::kNumericalFailure:
      break;
  }
  return "numerical failure";
}

}  // namespace

DriveFigures MeasureDrive(const sim::Scenario& scenario, const loop::Config& config,
                          const config::RouteFile& route, const CostWeights& weights,
                          const std::function<void(const can::Frame&)>& frame) {
  Meter meter(weights, config.mpc.t_s, route.route);
  const ClosedLoopHooks hooks{.frame = frame,
                              .step = [&](const StepObservation& observed) { meter.Take(observed); }};
  return meter.Result(DriveClosedLoop(scenario, config, route, hooks));
}

std::string ToText(const FirstFailure& failure) {
  std::string text = fmt::format("step {}, {}", failure.step, NameOf(failure.status));
  if (failure.violation) text += ": " + loop::ViolationText(*failure.violation);
  return text;
}

}  // namespace tools
