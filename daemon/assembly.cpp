#include "daemon/assembly.hpp"

#include <stdexcept>
#include <utility>

#include "config/route_file.hpp"
#include "config/text_file.hpp"
#include "dbc/parser.hpp"

namespace lpvmpcd {
namespace {

dbc::VehicleBus OpenBus(const std::filesystem::path& file) {
  if (file.empty()) {
    return {};
  }
  return dbc::VehicleBus(dbc::Parse(config::ReadTextFile(file), file.string()));
}

}  // namespace

Assembly::Assembly(const Config& config, std::function<Time()> stopwatch)
    : Assembly(config, config::LoadRoute(config.route), std::move(stopwatch)) {}

Assembly::Assembly(const Config& config, const config::RouteFile& route, std::function<Time()> stopwatch)
    : bus_(OpenBus(config.dbc)),
      reference_(control::SampleRoute(route.route, config.mpc.t_s), config.mpc.t_s),
      road_(route.road),
      controller_(config.vehicle, config.mpc),
      loop_(config.loop, bus_, controller_, reference_, road_, std::move(stopwatch)) {
  if (reference_.size() <= config.mpc.horizon) {
    throw std::runtime_error(config.route.string() + ": the route is shorter than the horizon");
  }
}

}  // namespace lpvmpcd
