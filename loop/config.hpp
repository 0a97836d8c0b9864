// The daemon's configuration: one TOML file. Its keys, defaults and allowed values are defined in
// loop/config_tables.hpp, from which the manual page lpvmpcd.toml(5) is generated. Unknown keys are refused.
//
// On SIGHUP a running daemon reads the file again, see daemon/reload.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "control/mpc/lpv_affine_mpc.hpp"
#include "control/mpc/lpv_mpc.hpp"
#include "control/road/road_profile.hpp"
#include "control/vehicle/vehicle_parameters.hpp"
#include "loop/control_loop.hpp"
#include "loop/service_settings.hpp"

namespace loop {

enum class ControllerKind : std::uint8_t { kLpvAffine, kLpv, kLpvStandard, kNmpc, kNmpcAffine };

// True for the paper's controllers, which treat the vehicle as a point and track a reference over time. The others,
// lpv-affine and nmpc-affine, keep the vehicle's rectangle on the road.
[[nodiscard]] constexpr bool IsPapers(ControllerKind kind) {
  return kind != ControllerKind::kLpvAffine && kind != ControllerKind::kNmpcAffine;
}
// True for the nonlinear controllers, solved by Ipopt.
[[nodiscard]] constexpr bool IsNmpc(ControllerKind kind) {
  return kind == ControllerKind::kNmpc || kind == ControllerKind::kNmpcAffine;
}

// A default-constructed Config corresponds to a file without keys.
struct Config {
  Config();

  std::filesystem::path dbc;  // empty: the built-in DBC
  std::filesystem::path route;
  // In the settings below, times, input bounds and values that depend on the controller are derived from loop.period,
  // loop.limits, `controller` and the values at the end.
  ServiceSettings service;
  LoopSettings loop;
  ControllerKind controller = ControllerKind::kLpvAffine;
  control::LpvMpcSettings mpc;        // settings of the paper's controllers
  control::LpvAffineSettings affine;  // settings of lpv-affine and nmpc-affine
  control::SpeedLimits speed;         // speed limits of lpv-affine and nmpc-affine
  bool offset_free = true;  // of lpv-affine and nmpc-affine; the paper's controllers know no disturbance
  control::VehicleParameters vehicle;
  std::string log_level = "info";
  std::map<std::string, std::string> written;  // the file's keys and values, except overridden ones

  std::optional<double> timeout;           // [s]; none: 1.5 periods
  std::optional<double> deadline;          // [s]; none: the period
  std::optional<double> engage_min_speed;  // [m/s]; none: the controller's default
  std::optional<control::State> P;         // none: mpc.Q
  double degraded_time = 1.0;              // [s], as a number of cycles in loop.modes
  double hold_time = 2.0;                  // likewise
  double max_steering_rate = 0.6;          // [rad/s], bounds affine.rate_max, which is per step
  double max_jerk = 20.0;                  // [m/s³], likewise
};

// Throws config::ConfigError with file, line, key, value and the allowed values.
[[nodiscard]] Config LoadConfig(const std::filesystem::path& file);

// Settings given on the command line instead of in the file.
void SelectInterface(Config& config, const std::string& name);
void SelectLockstep(Config& config);
// Selects a controller by its name in the file. Throws std::invalid_argument if there is none of this name.
void SelectController(Config& config, const std::string& name);
[[nodiscard]] const char* ControllerName(ControllerKind kind);
[[nodiscard]] std::vector<std::string> ControllerNames();  // names of all kinds

// N of the selected controller.
[[nodiscard]] int HorizonOf(const Config& config);
// Distance from obstacles that the controller chosen keeps where there is room [m].
[[nodiscard]] double ObstacleMarginOf(const Config& config);

}  // namespace loop
