#include "tools/paper/circle_drive.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "control/road/projection.hpp"
#include "tools/drive/closed_loop.hpp"

namespace tools {

CircleOutcome Drive(const CircleDrive& drive) {
  constexpr double kDuration = 12.0, kObstacleAfter = 7.0;  // [s]
  const std::array pieces{control::RoutePiece{.length = kDuration * drive.speed,
                                              .curvature_from = 1.0 / kCircleRadius,
                                              .curvature_to = 1.0 / kCircleRadius}};
  const config::RouteFile road{
      .route = control::Route::FromPieces({.X = 300.0, .Y = 0.0, .psi = 0.0}, drive.speed, pieces),
      .road = control::RoadBounds{.left = kCircleRoadHalfWidth, .right = -kCircleRoadHalfWidth}};

  sim::Scenario scenario(road.route, road.road);
  scenario.PlaceVehicle(0.0, drive.speed);
  const control::RoutePoint at = road.route.At(kObstacleAfter * drive.speed);
  const Eigen::Vector2d centre = control::Beside(at, drive.shift - kCircleObstacleRadius);
  scenario.obstacles = {{.id = 1,
                         .X = centre.x(),
                         .Y = centre.y(),
                         .r_x = kCircleObstacleRadius,
                         .r_y = kCircleObstacleRadius,
                         .side = control::PassingSide::kLeft}};

  loop::Config config;
  config.mpc.horizon = drive.horizon;
  loop::SelectController(config, loop::ControllerName(drive.controller));
  config.loop.send_horizon = false;
  // The first unsolved step determines the outcome.
  std::optional<CircleOutcome> unsolved;
  const ClosedLoopHooks hooks{
      .step =
          [&](const StepObservation& observed) {
            if (unsolved || observed.plan.status == control::SolverStatus::kSolved) return;
            const auto violation = observed.controller.DiagnoseInfeasibility();
            const bool marginal = violation &&
                                  violation->constraint.kind == control::ConstraintKind::kObstacle &&
                                  violation->amount < kMarginalShortfall;
            unsolved = marginal ? CircleOutcome::kMarginal : CircleOutcome::kInfeasible;
          },
      .stop = [&] { return unsolved.has_value(); }};
  const sim::Summary summary = DriveClosedLoop(scenario, config, road, hooks);
  if (unsolved) return *unsolved;
  if (!summary.completed) return CircleOutcome::kInfeasible;
  if (summary.min_clearance_m.value_or(0.0) < 0.0) return CircleOutcome::kTouch;
  if (summary.min_road_margin_m.value_or(0.0) < 0.0) return CircleOutcome::kOffRoad;
  return CircleOutcome::kClear;
}

}  // namespace tools
