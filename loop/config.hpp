// The daemon's configuration: one TOML file. A key that is not listed here is refused.
//
//   [bus]         interface = "can0"            CAN interface
//                 dbc = "FILE"                  another definition of our messages; none: the built-in dbc/vehicle.dbc
//   [route]       file = "FILE"                 route file (config/route_file.hpp); required
//   [cycle]       period = 0.05                 t_s of bus, reference and controller [s], 0.005..1
//                 timeout = 1.5 period          after a state, until a cycle runs without one [s]; period..1.5
//                 deadline = period             age of a state at which its command would come too late [s]; 0.001..period;
//                                               none in lock step
//                 command_delay = 0.0           from a command to its effect, by which the state is propagated [s], 0..0.5
//                 lockstep = false              time by the vehicle's counter: repeatable, for simulation only; refused on
//                                               an interface that is not virtual
//   [monitor]     stale_periods = 3.0           age, in its periods, above which a message is stale; 1..1000
//                 max_lost = 2                  frames that may be missing between two accepted ones; 0..13
//   [engage]      min_speed = 0.0               [m/s], 0..50; 3.0 with the paper's controllers
//                 max_heading_error = 0.5       against the route [rad], 0..3.15
//   [degraded]    max_time = 1.0                drive on without a new plan, obstacles or the driver's request [s], 0..10
//   [safe_stop]   deceleration = 3.0            [m/s²], 0.1..10, not above −min_acceleration
//                 standstill_speed = 0.3        below it the vehicle stands [m/s], 0.01..5
//   [limits]      max_steering = 0.593412       |δ| [rad], 0.01..1.04
//                 max_steering_step = 0.436332  |δ_k − δ_{k−1}| [rad], 0.001..2
//                 min_acceleration = -6.0       [m/s²], -13..-0.1
//                 max_acceleration = 2.0        [m/s²], 0..13
//                 max_acceleration_step = 1.5   |a_k − a_{k−1}| [m/s²], 0.01..20
//                 (of the problem that is solved and of the limiter after it)
//   [controller]  kind = "lpv-affine"           "lpv-affine": see [lpv_affine]; "lpv": the paper's, with the scheduling
//                                               trust region; "lpv-standard": the same without;
//                                               for lpvmpc alone, the daemon refuses them: "nmpc": the paper's;
//                                               "nmpc-affine": the problem of lpv-affine, nonlinear
//                 (the keys below are those of the paper's controllers)
//                 horizon = 8                   N, 2..100
//                 discretisation = "euler"      "euler" as in the paper, or "zero-order-hold"; nmpc: Euler always
//                 Q = [10, 10, 1, 1, 10, 1]     weights of the error in X Y υ ν ψ ω, each >= 0
//                 P = Q                         those of the last step
//                 R = [0.1, 0.1]                weights of δ and a, each > 0
//                 E_p = [1e3, 1e3, 1e3, 1e3]    weights of the trust region's slacks, each > 0
//                 trust_radius = [0.5, 0.3, 0.05, 0.05]   of υ [m/s], ν [m/s], ψ [rad], δ [rad], each > 0
//                 obstacle_margin = 0.1         by which obstacles are enlarged [m], 0..5
//                 z_min, z_max                  bounds on X Y υ ν ψ ω; that on ψ is relative to the reference
//   [lpv_affine]  horizon = 40                  N, 2..100
//                 Q = [2, 2, 1, 1, 20, 100]     weights of the error in X Y υ ν ψ ω, each >= 0
//                 terminal = 5.0                those of the last step are so many times Q, 0..1e6
//                 R = [5, 0.2]                  weights of δ and a, less the reference's, each > 0
//                 R_rate = [2000, 10]           weights of their change in a step, each > 0
//                 trust_region = "adaptive"     radii by the last prediction's error; "fixed": as given; "none"
//                 trust_radius = [1, 0.5, 0.1, 0.1]   of υ [m/s], ν [m/s], ψ [rad], δ [rad], each > 0
//                 mu = 0.7                      friction coefficient that is reckoned with, 0.05..1.5
//                 friction_share = 0.9          of it that a plan may use, 0.1..1
//                 obstacle_margin = 0.3         [m], 0..5
//                 road_margin = 0.4             [m], 0..5
//                 stop_gap = 2.0                before an obstacle that cannot be passed [m], 0..50
//                 max_steering_rate = 0.6       of a plan [rad/s], 0.01..10
//                 max_jerk = 20.0               of a plan [m/s³], 0.1..400
//                 iterations = 1                QPs in one cycle, while there is time, 1..20
//                 lateral_acceleration = 3.0    in curves, if the target speed is not lower [m/s²], 0.1..13
//                 acceleration = 1.5            towards a higher target speed [m/s²], 0.1..13
//                 deceleration = 2.0            towards a lower one and the end of the route [m/s²], 0.1..13
//   [vehicle]     m, I_z, l_f, l_r, C_alpha_f, C_alpha_r        see control/vehicle/vehicle_parameters.hpp
//                 front = 1.95                  from the centre of gravity to the front end [m], 0..20
//                 rear = 2.3                    and to the rear end [m], 0..20
//                 width = 1.8                   [m], 0..5
//                 (the paper's controllers take the vehicle for a point)
//   [status]      horizon = true                send the planned horizon
//   [log]         level = "info"                "debug", "info", "warning", "error"
//   [realtime]    fifo_priority = 0             of SCHED_FIFO, 1..99; 0: usual scheduling
//                 lock_memory = false           no page faults: memory locked, stack touched; needs RLIMIT_MEMLOCK
//                 cpus = []                     the only CPUs to run on, each 0..1023; none: all
//                 (what the kernel refuses is done without, and told)
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

struct Config {
  std::filesystem::path dbc;  // empty: built in
  std::filesystem::path route;
  ServiceSettings service;
  LoopSettings loop;
  ControllerKind controller = ControllerKind::kLpvAffine;
  control::LpvMpcSettings mpc;        // of the paper's controllers; its trust_region is that of `controller`
  control::LpvAffineSettings affine;  // and of nmpc-affine; inputs and rates within loop.limits
  control::SpeedLimits speed;         // of both
  std::optional<double> engage_min_speed;  // as written
  control::VehicleParameters vehicle;
  std::string log_level = "info";
  std::map<std::string, std::string> written;  // the file's keys and values, but for those overridden
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
