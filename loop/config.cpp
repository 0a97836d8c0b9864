#include "loop/config.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>
#include <vector>

#include "config/toml_table.hpp"

namespace loop {
namespace {

using config::TomlTable;

constexpr double kSmallest = 1e-9;  // of what has to be positive
constexpr double kLargest = 1e12;
constexpr std::array kControllerNames{"lpv-affine", "lpv", "lpv-standard", "nmpc",
                                      "nmpc-affine"};  // in the order of ControllerKind

// Sets `vector` from the array under `key`, if it is there.
template <typename Vector>
void ReadVector(const TomlTable& table, const char* key, Vector& vector, config::Range<double> range) {
  if (table.Has(key)) {
    const std::vector<double> values = table.Numbers(key, static_cast<std::size_t>(vector.size()), range);
    std::ranges::copy(values, vector.data());
  }
}

void RunInLockstep(Config& config) {
  config.service.lockstep = true;
  config.loop.deadline = base::Time::max();  // the vehicle waits
}

void ReadCycle(const TomlTable& table, Config& config) {
  const double period = table.NumberOr("period", 0.05, {0.005, 1.0}, "s");
  const double timeout = table.NumberOr("timeout", 1.5 * period, {0.005, 1.5}, "s");
  if (timeout < period) {
    throw table.Error("timeout", "must not be shorter than the period");
  }
  config.service.period = base::FromSeconds(period);
  config.service.timeout = base::FromSeconds(timeout);
  config.loop.period = config.service.period;
  config.loop.deadline = base::FromSeconds(table.NumberOr("deadline", period, {0.001, period}, "s"));
  config.loop.command_delay = base::FromSeconds(table.NumberOr("command_delay", 0.0, {0.0, 0.5}, "s"));
  config.mpc.t_s = period;
  if (table.BooleanOr("lockstep", false)) {
    RunInLockstep(config);
  }
}

void ReadMonitor(const TomlTable& table, safety::MonitorSettings& monitor) {
  monitor.stale_periods = table.NumberOr("stale_periods", monitor.stale_periods, {1.0, 1000.0});
  monitor.max_lost = table.IntegerOr("max_lost", monitor.max_lost, {0, 13});
}

void ReadLimits(const TomlTable& table, Config& config) {
  safety::CommandLimits& l = config.loop.limits;
  l.max_steering = table.NumberOr("max_steering", l.max_steering, {0.01, 1.04}, "rad");
  l.max_steering_step = table.NumberOr("max_steering_step", l.max_steering_step, {0.001, 2.0}, "rad");
  l.min_acceleration = table.NumberOr("min_acceleration", l.min_acceleration, {-13.0, -0.1}, "m/s^2");
  l.max_acceleration = table.NumberOr("max_acceleration", l.max_acceleration, {0.0, 13.0}, "m/s^2");
  l.max_acceleration_step =
      table.NumberOr("max_acceleration_step", l.max_acceleration_step, {0.01, 20.0}, "m/s^2");
  config.mpc.u_min = {-l.max_steering, l.min_acceleration};
  config.mpc.u_max = {l.max_steering, l.max_acceleration};
  config.mpc.rate_max = {l.max_steering_step, l.max_acceleration_step};
  config.affine.u_min = config.mpc.u_min;
  config.affine.u_max = config.mpc.u_max;
}

void Select(Config& config, ControllerKind kind) {
  config.controller = kind;
  config.mpc.trust_region = kind == ControllerKind::kLpv;
  // The paper's model divides by the speed, and its reference does not wait for a vehicle that is late.
  config.loop.engage_min_speed = config.engage_min_speed.value_or(IsPapers(kind) ? 3.0 : 0.0);
}

void ReadController(const TomlTable& table, Config& config) {
  Select(config, static_cast<ControllerKind>(
                     table.ChoiceOr("kind", 0, {kControllerNames.begin(), kControllerNames.end()})));
  control::LpvMpcSettings& mpc = config.mpc;
  mpc.horizon = table.IntegerOr("horizon", mpc.horizon, {2, 100});
  const bool euler = table.ChoiceOr("discretisation", 0, {"euler", "zero-order-hold"}) == 0;
  mpc.discretisation = euler ? control::Discretisation::kEuler : control::Discretisation::kZeroOrderHold;
  ReadVector(table, "Q", mpc.Q, {0.0, kLargest});
  mpc.P = mpc.Q;
  ReadVector(table, "P", mpc.P, {0.0, kLargest});
  ReadVector(table, "R", mpc.R, {kSmallest, kLargest});
  ReadVector(table, "E_p", mpc.E_p, {kSmallest, kLargest});
  ReadVector(table, "trust_radius", mpc.trust_radius, {kSmallest, kLargest});
  mpc.obstacle_margin = table.NumberOr("obstacle_margin", mpc.obstacle_margin, {0.0, 5.0}, "m");
  ReadVector(table, "z_min", mpc.z_min, {});
  ReadVector(table, "z_max", mpc.z_max, {});
  if ((mpc.z_min.array() >= mpc.z_max.array()).any()) {
    throw table.Error(table.Has("z_max") ? "z_max" : "z_min", "each of z_min must be below its z_max");
  }
}

// After the limits and the cycle.
void ReadLpvAffine(const TomlTable& table, Config& config) {
  control::LpvAffineSettings& mpc = config.affine;
  mpc.t_s = base::ToSeconds(config.loop.period);
  mpc.horizon = table.IntegerOr("horizon", mpc.horizon, {2, 100});
  ReadVector(table, "Q", mpc.Q, {0.0, kLargest});
  mpc.terminal = table.NumberOr("terminal", mpc.terminal, {0.0, 1e6});
  ReadVector(table, "R", mpc.R, {kSmallest, kLargest});
  ReadVector(table, "R_rate", mpc.R_rate, {kSmallest, kLargest});
  const std::size_t trust = table.ChoiceOr("trust_region", 0, {"adaptive", "fixed", "none"});
  mpc.adapt_trust_region = trust == 0;
  mpc.trust_region = trust < 2;
  ReadVector(table, "trust_radius", mpc.trust_radius, {kSmallest, kLargest});
  mpc.mu = table.NumberOr("mu", mpc.mu, {0.05, 1.5});
  mpc.friction_share = table.NumberOr("friction_share", mpc.friction_share, {0.1, 1.0});
  mpc.obstacle_margin = table.NumberOr("obstacle_margin", mpc.obstacle_margin, {0.0, 5.0}, "m");
  mpc.road_margin = table.NumberOr("road_margin", mpc.road_margin, {0.0, 5.0}, "m");
  mpc.stop_gap = table.NumberOr("stop_gap", mpc.stop_gap, {0.0, 50.0}, "m");
  const double steering_rate = table.NumberOr("max_steering_rate", 0.6, {0.01, 10.0}, "rad/s");
  const double jerk = table.NumberOr("max_jerk", 20.0, {0.1, 400.0}, "m/s^3");
  mpc.rate_max = config.mpc.rate_max.cwiseMin(mpc.t_s * control::Input(steering_rate, jerk));
  mpc.iterations = table.IntegerOr("iterations", mpc.iterations, {1, 20});
  control::SpeedLimits& speed = config.speed;
  speed.lateral = table.NumberOr("lateral_acceleration", speed.lateral, {0.1, 13.0}, "m/s^2");
  speed.acceleration = table.NumberOr("acceleration", speed.acceleration, {0.1, 13.0}, "m/s^2");
  speed.deceleration = table.NumberOr("deceleration", speed.deceleration, {0.1, 13.0}, "m/s^2");
}

void ReadFootprint(const TomlTable& table, control::Footprint& footprint) {
  footprint.front = table.NumberOr("front", footprint.front, {0.0, 20.0}, "m");
  footprint.rear = table.NumberOr("rear", footprint.rear, {0.0, 20.0}, "m");
  footprint.half_width = 0.5 * table.NumberOr("width", 2.0 * footprint.half_width, {0.0, 5.0}, "m");
}

void ReadVehicle(const TomlTable& table, control::VehicleParameters& vehicle) {
  vehicle.m = table.NumberOr("m", vehicle.m, {100.0, 1e5}, "kg");
  vehicle.I_z = table.NumberOr("I_z", vehicle.I_z, {10.0, 1e6}, "kg m^2");
  vehicle.l_f = table.NumberOr("l_f", vehicle.l_f, {0.1, 20.0}, "m");
  vehicle.l_r = table.NumberOr("l_r", vehicle.l_r, {0.1, 20.0}, "m");
  vehicle.C_alpha_f = table.NumberOr("C_alpha_f", vehicle.C_alpha_f, {1e3, 1e7}, "N/rad");
  vehicle.C_alpha_r = table.NumberOr("C_alpha_r", vehicle.C_alpha_r, {1e3, 1e7}, "N/rad");
}

void ReadModes(const TomlTable& engage, const TomlTable& degraded, const TomlTable& stop,
               LoopSettings& loop) {
  loop.engage_max_heading_error =
      engage.NumberOr("max_heading_error", loop.engage_max_heading_error, {0.0, 3.15}, "rad");
  const double max_time = degraded.NumberOr("max_time", 1.0, {0.0, 10.0}, "s");
  loop.modes.degraded_cycles = static_cast<int>(std::lround(max_time / base::ToSeconds(loop.period)));
  loop.stop_deceleration = stop.NumberOr("deceleration", loop.stop_deceleration, {0.1, 10.0}, "m/s^2");
  if (loop.stop_deceleration > -loop.limits.min_acceleration) {
    const std::string unless =
        stop.Has("deceleration") ? "" : fmt::format(" ({} unless given)", loop.stop_deceleration);
    throw stop.Error("deceleration",
                     fmt::format("must not be above {}, the strongest brake of limits.min_acceleration{}",
                                 -loop.limits.min_acceleration, unless));
  }
  loop.standstill_speed = stop.NumberOr("standstill_speed", loop.standstill_speed, {0.01, 5.0}, "m/s");
}

void ReadRealTime(const TomlTable& table, RealTimeSettings& settings) {
  settings.fifo_priority = table.IntegerOr("fifo_priority", settings.fifo_priority, {0, 99});
  settings.lock_memory = table.BooleanOr("lock_memory", settings.lock_memory);
  if (table.Has("cpus")) {
    for (const double cpu : table.Numbers("cpus", 0, {0.0, 1023.0})) {
      if (cpu != std::floor(cpu)) {
        throw table.Error("cpus", fmt::format("must be whole numbers, not {}", cpu));
      }
      settings.cpus.push_back(static_cast<int>(cpu));
    }
  }
}

}  // namespace

Config LoadConfig(const std::filesystem::path& file) {
  const TomlTable root = TomlTable::Read(file);
  Config config;
  const TomlTable bus = root.Table("bus");
  config.service.interface = bus.TextOr("interface", "can0");
  if (bus.Has("dbc")) {
    config.dbc = bus.Path("dbc");
  }
  config.route = root.Table("route").Path("file");
  ReadCycle(root.Table("cycle"), config);
  ReadMonitor(root.Table("monitor"), config.loop.monitor);
  ReadLimits(root.Table("limits"), config);
  ReadModes(root.Table("engage"), root.Table("degraded"), root.Table("safe_stop"), config.loop);
  if (root.Table("engage").Has("min_speed")) {
    config.engage_min_speed = root.Table("engage").Number("min_speed", {0.0, 50.0}, "m/s");
  }
  ReadController(root.Table("controller"), config);
  ReadLpvAffine(root.Table("lpv_affine"), config);
  ReadVehicle(root.Table("vehicle"), config.vehicle);
  ReadFootprint(root.Table("vehicle"), config.affine.footprint);
  config.loop.vehicle = config.vehicle;
  config.loop.send_horizon = root.Table("status").BooleanOr("horizon", config.loop.send_horizon);
  const std::vector<std::string> levels = {"debug", "info", "warning", "error"};
  config.log_level = levels[root.Table("log").ChoiceOr("level", 1, levels)];
  ReadRealTime(root.Table("realtime"), config.service.real_time);
  root.RefuseUnknownKeys();
  config.written = root.Values();
  return config;
}

void SelectInterface(Config& config, const std::string& name) {
  config.service.interface = name;
  config.written.erase("bus.interface");
}

void SelectLockstep(Config& config) {
  RunInLockstep(config);
  config.written.erase("cycle.lockstep");
}

void SelectController(Config& config, const std::string& name) {
  const auto known = std::ranges::find(kControllerNames, name);
  if (known == kControllerNames.end()) {
    throw std::invalid_argument(
        fmt::format("no controller \"{}\": {}", name, fmt::join(kControllerNames, ", ")));
  }
  Select(config, static_cast<ControllerKind>(known - kControllerNames.begin()));
  config.written.erase("controller.kind");
}

int HorizonOf(const Config& config) {
  return IsPapers(config.controller) ? config.mpc.horizon : config.affine.horizon;
}

const char* ControllerName(ControllerKind kind) {
  return kControllerNames.at(static_cast<std::size_t>(kind));
}

std::vector<std::string> ControllerNames() {
  return {kControllerNames.begin(), kControllerNames.end()};
}

}  // namespace loop
