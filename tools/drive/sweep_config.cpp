#include "tools/drive/sweep_config.hpp"

#include <algorithm>

namespace tools {
namespace {

// Lateral displacement of a front corner at a heading error of 0.1 rad [m].
constexpr double kCornerSwing = 0.2;
// Time from a command to its effect, dead time plus steering lag [s]; the mean of the random scenarios is 0.055 s.
constexpr double kMeanDelay = 0.05;

std::string DaemonsName(const std::string& controller) {
  using enum loop::ControllerKind;
  if (controller == kFixedRadius) return loop::ControllerName(kLpvAffine);
  return controller;
}

}  // namespace

loop::Config ConfigFor(const std::string& controller, const ScenarioRanges& ranges) {
  loop::Config config;
  loop::SelectController(config, DaemonsName(controller));
  config.affine.adapt_trust_region = controller != kFixedRadius;
  config.mpc.obstacle_margin += kVehicleFootprint.half_width + kCornerSwing;
  config.affine.footprint = kVehicleFootprint;
  config.affine.mu = ranges.mu.low;
  if (!IsPapers(config.controller)) {
    config.loop.command_delay = base::FromSeconds(kMeanDelay);
  }
  config.service.interface = "vcan0";  // the interface's name in logs
  // Vehicles start at 0.9 to 1.1 times the target speed, which may be below the daemon's minimum for engagement.
  config.loop.engage_min_speed = std::min(config.loop.engage_min_speed, 0.5 * ranges.speed.low);
  return config;
}

std::vector<std::string> SweepControllers() {
  using enum loop::ControllerKind;
  return {loop::ControllerName(kLpvAffine), kFixedRadius, loop::ControllerName(kLpv),
          loop::ControllerName(kLpvStandard), loop::ControllerName(kNmpcAffine)};
}

config::RouteFile RouteFor(const RandomScenario& drawn, const loop::Config& config) {
  config::RouteFile route = drawn.route;
  if (!IsPapers(config.controller)) return route;
  route.road = route.road.Inset(drawn.scenario.footprint.half_width);
  return route;
}

}  // namespace tools
