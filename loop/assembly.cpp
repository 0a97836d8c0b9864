#include "loop/assembly.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "config/route_file.hpp"
#include "config/text_file.hpp"
#include "control/mpc/lpv_affine_mpc.hpp"
#include "control/mpc/lpv_mpc.hpp"
#include "control/mpc/timed_controller.hpp"
#include "dbc/parser.hpp"

namespace loop {

std::unique_ptr<control::Controller> MakeController(const Config& config, const Road& road) {
  switch (config.controller) {
    case ControllerKind::kLpvAffine:
      return std::make_unique<control::LpvAffineMpc>(config.vehicle, road.profile, config.affine);
    case ControllerKind::kLpv:
    case ControllerKind::kLpvStandard:
      return std::make_unique<control::TimedController>(
          std::make_unique<control::LpvMpc>(config.vehicle, config.mpc), road.reference,
          road.profile.edges());
    case ControllerKind::kNmpc:
    case ControllerKind::kNmpcAffine:
      break;
  }
  // Ipopt allocates memory and its run time is not bounded.
  throw std::runtime_error(
      std::string("controller ") + ControllerName(config.controller) +
      " is for lpvmpc alone; the daemon does not support it: take lpv-affine, lpv or lpv-standard");
}

bus::VehicleBus OpenBus(const Config& config) {
  if (config.dbc.empty()) {
    return {};
  }
  return bus::VehicleBus(dbc::Parse(config::ReadTextFile(config.dbc), config.dbc.string()));
}

namespace {

LoopSettings LoopOf(const Config& config) {
  LoopSettings settings = config.loop;
  settings.mu = config.affine.mu;
  return settings;
}

}  // namespace

Assembly::Assembly(const Config& config, std::function<base::Time()> stopwatch)
    : Assembly(config, config::LoadRoute(config.route), std::move(stopwatch), MakeController) {}

Assembly::Assembly(const Config& config, const config::RouteFile& route,
                   std::function<base::Time()> stopwatch, const ControllerMaker& make)
    : bus_(OpenBus(config)),
      reference_(control::SampleRoute(route.route, config.mpc.t_s), config.mpc.t_s),
      profile_(route.route, route.road, config.speed),
      controller_(make(config, {.reference = reference_, .profile = profile_})),
      check_({.vehicle = config.vehicle,
              .footprint = config.affine.footprint,
              .mu = config.affine.mu,
              .t_s = config.affine.t_s,
              .stop_deceleration = config.loop.stop_deceleration,
              .hardest_deceleration = -config.loop.limits.min_acceleration,
              .jerk = config.loop.limits.max_acceleration_step / config.affine.t_s},
             profile_),
      // The paper's controllers plan for a point mass with a coarser model: their plans would not pass the check.
      loop_(LoopOf(config), bus_, *controller_, reference_, profile_, std::move(stopwatch),
            IsPapers(config.controller) ? nullptr : &check_) {
  if (reference_.size() <= HorizonOf(config)) {
    throw std::runtime_error(config.route.string() + ": the route is shorter than the horizon");
  }
}

}  // namespace loop
