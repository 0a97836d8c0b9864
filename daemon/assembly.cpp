#include "daemon/assembly.hpp"

#include <stdexcept>
#include <utility>

#include "config/route_file.hpp"
#include "config/text_file.hpp"
#include "control/lpv_mpc.hpp"
#include "dbc/parser.hpp"

namespace lpvmpcd {
namespace {

std::unique_ptr<control::Controller> MakeController(const Config& config) {
  if (config.controller == ControllerKind::kNmpc) {
    // Ipopt allocates and has no bound on its time.
    throw std::runtime_error(
        "controller nmpc is for lpvmpc alone: no daemon drives by it; take lpv or lpv-standard");
  }
  return std::make_unique<control::LpvMpc>(config.vehicle, config.mpc);
}

}  // namespace

dbc::VehicleBus OpenBus(const Config& config) {
  if (config.dbc.empty()) {
    return {};
  }
  return dbc::VehicleBus(dbc::Parse(config::ReadTextFile(config.dbc), config.dbc.string()));
}

Assembly::Assembly(const Config& config, std::function<Time()> stopwatch)
    : Assembly(config, config::LoadRoute(config.route), std::move(stopwatch), MakeController(config)) {}

Assembly::Assembly(const Config& config, const config::RouteFile& route, std::function<Time()> stopwatch,
                   std::unique_ptr<control::Controller> controller)
    : bus_(OpenBus(config)),
      reference_(control::SampleRoute(route.route, config.mpc.t_s), config.mpc.t_s),
      road_(route.road),
      controller_(std::move(controller)),
      loop_(config.loop, bus_, *controller_, reference_, road_, std::move(stopwatch)) {
  if (reference_.size() <= config.mpc.horizon) {
    throw std::runtime_error(config.route.string() + ": the route is shorter than the horizon");
  }
}

}  // namespace lpvmpcd
