// The daemon's configuration: one TOML file. Its keys, their defaults and what is allowed: loop/config_tables.hpp, and the
// manual page lpvmpcd.toml(5), which is made of them. A key that is not there is refused.
//
// On SIGHUP a running daemon reads the file again: daemon/reload.hpp.
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

// One of the paper's controllers, which take the vehicle for a point and track a reference by time. The others, lpv-affine and
// nmpc-affine, hold the vehicle's rectangle on the road.
[[nodiscard]] constexpr bool IsPapers(ControllerKind kind) {
  return kind != ControllerKind::kLpvAffine && kind != ControllerKind::kNmpcAffine;
}
// Nonlinear, by Ipopt.
[[nodiscard]] constexpr bool IsNmpc(ControllerKind kind) {
  return kind == ControllerKind::kNmpc || kind == ControllerKind::kNmpcAffine;
}

// A default-constructed Config is that of a file without keys.
struct Config {
  Config();

  std::filesystem::path dbc;  // empty: built in
  std::filesystem::path route;
  // Of these settings, times, bounds of the inputs, and what depends on the controller follow from loop.period,
  // loop.limits, `controller` and the values at the end.
  ServiceSettings service;
  LoopSettings loop;
  ControllerKind controller = ControllerKind::kLpvAffine;
  control::LpvMpcSettings mpc;        // of the paper's controllers
  control::LpvAffineSettings affine;  // of lpv-affine and nmpc-affine
  control::SpeedLimits speed;         // of lpv-affine and nmpc-affine
  control::VehicleParameters vehicle;
  std::string log_level = "info";
  std::map<std::string, std::string> written;  // the file's keys and values, but for those overridden

  std::optional<double> timeout;           // [s]; none: 1.5 periods
  std::optional<double> deadline;          // [s]; none: the period
  std::optional<double> engage_min_speed;  // [m/s]; none: that of the controller
  std::optional<control::State> P;         // none: mpc.Q
  double degraded_time = 1.0;              // [s], as a number of cycles in loop.modes
  double max_steering_rate = 0.6;          // [rad/s], a step of it in affine.rate_max
  double max_jerk = 20.0;                  // [m/s³], likewise
};

// Throws config::ConfigError: file, line, key, value and what is allowed.
[[nodiscard]] Config LoadConfig(const std::filesystem::path& file);

// What is given elsewhere and not by the file.
void SelectInterface(Config& config, const std::string& name);
void SelectLockstep(Config& config);
// Choice of a controller by its name, as in the file. Throws std::invalid_argument.
void SelectController(Config& config, const std::string& name);
[[nodiscard]] const char* ControllerName(ControllerKind kind);
[[nodiscard]] std::vector<std::string> ControllerNames();  // of all kinds

// N of the controller chosen.
[[nodiscard]] int HorizonOf(const Config& config);

}  // namespace loop
