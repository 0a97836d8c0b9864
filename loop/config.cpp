#include "loop/config.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "config/toml_table.hpp"
#include "loop/config_tables.hpp"

namespace loop {
namespace {

using config::TomlTable;

constexpr std::array kControllerNames{"lpv-affine", "lpv", "lpv-standard", "nmpc",
                                      "nmpc-affine"};  // in the order of ControllerKind

void DeriveFromController(Config& config) {
  config.mpc.trust_region = config.controller == ControllerKind::kLpv;
  config.loop.offset_free = config.offset_free && !IsPapers(config.controller);
  // The paper's model divides by the speed, and its reference does not wait for a late vehicle.
  config.loop.engage_min_speed = config.engage_min_speed.value_or(IsPapers(config.controller) ? 3.0 : 0.0);
}

// In lock step there is no deadline: the vehicle waits for the answers.
void DeriveDeadline(Config& config) {
  const double deadline = config.deadline.value_or(base::ToSeconds(config.loop.period));
  config.loop.deadline = config.service.lockstep ? base::Time::max() : base::FromSeconds(deadline);
}

// Sets the members that follow from others and have no key.
void Derive(Config& config) {
  const double t_s = base::ToSeconds(config.loop.period);
  config.service.period = config.loop.period;
  config.service.timeout = base::FromSeconds(config.timeout.value_or(1.5 * t_s));
  config.loop.modes.degraded_cycles = static_cast<int>(std::lround(config.degraded_time / t_s));
  config.loop.modes.hold_cycles = static_cast<int>(std::lround(config.hold_time / t_s));
  config.loop.vehicle = config.vehicle;
  config.mpc.t_s = config.affine.t_s = t_s;

  const safety::CommandLimits& limits = config.loop.limits;
  config.mpc.u_min = config.affine.u_min = {-limits.max_steering, limits.min_acceleration};
  config.mpc.u_max = config.affine.u_max = {limits.max_steering, limits.max_acceleration};
  config.mpc.rate_max = {limits.max_steering_step, limits.max_acceleration_step};
  config.affine.rate_max =
      config.mpc.rate_max.cwiseMin(t_s * control::Input(config.max_steering_rate, config.max_jerk));
  config.mpc.P = config.P.value_or(config.mpc.Q);

  DeriveDeadline(config);
  DeriveFromController(config);
}

// Throws config::ConfigError if values are allowed individually but not together.
void RefuseContradictions(const TomlTable& root, const Config& config) {
  if ((config.mpc.z_min.array() >= config.mpc.z_max.array()).any()) {
    const TomlTable table = root.Table("controller");
    throw table.Error(table.Has("z_max") ? "z_max" : "z_min", "each of z_min must be below its z_max");
  }
  const double strongest = -config.loop.limits.min_acceleration;
  if (config.loop.stop_deceleration > strongest) {
    const TomlTable stop = root.Table("safe_stop");
    const std::string unless =
        stop.Has("deceleration") ? "" : fmt::format(" (default {})", config.loop.stop_deceleration);
    throw stop.Error("deceleration",
                     fmt::format("must not be above {}, the strongest braking of limits.min_acceleration{}",
                                 strongest, unless));
  }
}

}  // namespace

Config::Config() {
  Derive(*this);
}

Config LoadConfig(const std::filesystem::path& file) {
  const TomlTable root = TomlTable::Read(file);
  Config config;
  for (const ConfigTable& table : ConfigTables()) {
    for (const ConfigKey& key : table.keys) {
      key.read(root.Table(table.name), config);
    }
  }
  RefuseContradictions(root, config);
  root.RefuseUnknownKeys();
  Derive(config);
  config.written = root.Values();
  return config;
}

void SelectInterface(Config& config, const std::string& name) {
  config.service.interface = name;
  config.written.erase("bus.interface");
}

void SelectLockstep(Config& config) {
  config.service.lockstep = true;
  DeriveDeadline(config);
  config.written.erase("cycle.lockstep");
}

void SelectController(Config& config, const std::string& name) {
  const auto known = std::ranges::find(kControllerNames, name);
  if (known == kControllerNames.end()) {
    throw std::invalid_argument(
        fmt::format("no controller \"{}\": {}", name, fmt::join(kControllerNames, ", ")));
  }
  config.controller = static_cast<ControllerKind>(known - kControllerNames.begin());
  DeriveFromController(config);
  config.written.erase("controller.kind");
}

int HorizonOf(const Config& config) {
  return IsPapers(config.controller) ? config.mpc.horizon : config.affine.horizon;
}

double ObstacleMarginOf(const Config& config) {
  return IsPapers(config.controller) ? config.mpc.obstacle_margin : config.affine.obstacle_margin;
}

const char* ControllerName(ControllerKind kind) {
  return kControllerNames.at(static_cast<std::size_t>(kind));
}

std::vector<std::string> ControllerNames() {
  return {kControllerNames.begin(), kControllerNames.end()};
}

}  // namespace loop
