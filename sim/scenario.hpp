// One simulated drive: the road, the vehicle and its differences from the controller's model, the obstacles, the
// driver, and the expectations that decide whether the drive passed. It is a TOML file; only `name` and `route` are
// required, and for each obstacle `id`, `r_x`, `r_y` and a place: X and Y, or s.
//
//   name = "demo"                     # one line
//   description = "..."
//   seed = 1                          # of the sensors' noise, 0..2147483647
//   duration = 60.0                   # [s]; default: to the end of the route
//   route = "route.toml"              # config/route_file.hpp; paths are relative to this file
//   daemon_config = "lpvmpcd.toml"    # for the tools that start the daemon
//   [initial]                         # place relative to the route
//   along = 0.0                       # [m]
//   lateral = 0.0                     # left positive [m]
//   heading = 0.0                     # [rad]
//   speed = 12.0                      # default: the route's target speed there [m/s]
//   [[obstacle]]                      # at most 64
//   id = 1                            # 0..63, each once
//   X = 100.0                         # centre in the map [m], inside the map's bounds below
//   Y = 20.0
//   shape = "ellipse"                 # or box
//   r_x = 1.0                         # semi-axis or half side along the heading, 0.05..20 [m]
//   r_y = 1.0                         # across the heading
//   heading = 0.0                     # in the map [rad]
//   velocity_X = 0.0                  # in the map [m/s]
//   velocity_Y = 0.0
//   side = "left"                     # on which to pass it: left, right, unknown
//   class = "unknown"                 # or static, vehicle, cycle, pedestrian
//   appears_at = 0.0                  # the obstacle exists, but is not perceived, before that time [s]
//   disappears_at = 40.0              # default: never; the obstacle does not exist from that time on [s]
//   [[obstacle]]
//   id = 2
//   s = 100.0                         # instead of X and Y: arc length of the centre [m]
//   lateral = -0.3                    # offset from the route, left positive [m]
//   heading = 0.0                     # here relative to the route [rad]
//   r_x = 1.0
//   r_y = 0.5
//   [[obstacle]]
//   id = 3
//   s = 150.0
//   r_x = 2.3
//   r_y = 0.9
//   along_route = true                # moves along the route and turns with it; instead of velocity_X and velocity_Y
//   heading = 3.14159                 # here oncoming
//   lateral = 2.0                     # kept, unless there is a lateral_profile
//   speed = -8.0                      # along the route, default 0; negative: against its direction [m/s]
//   [[obstacle]]
//   id = 4
//   s = 40.0
//   r_x = 2.3
//   r_y = 0.9
//   along_route = true
//   speed_profile = [{time = 5.0, speed = 10.0}, {time = 8.0, speed = 0.0}]  # instead of speed: linear in between, by
//                                     # time since the start; before and after the speed is constant
//   lateral_profile = [{time = 3.0, lateral = 3.5}, {time = 6.0, lateral = 0.0}]  # instead of lateral: with a smooth
//                                     # shift in between; heading and velocity turn along
//   [[obstacle]]
//   id = 5
//   s = 0.0
//   r_x = 2.3
//   r_y = 0.9
//   along_route = true
//   speed = 14.0                      # that the driver wants, not 0
//   follows = true                    # keeps a distance to our vehicle while that is ahead in its way: sim/follower.hpp
//   [vehicle]                         # its rectangle, and deviations from control/vehicle/vehicle_parameters.hpp
//   front = 0.0                       # from the centre of gravity to the front end [m]
//   rear = 0.0                        # from the centre of gravity to the rear end [m]
//   width = 0.0                       # [m]; all three 0: a point
//   mass_factor = 1.0                 # of mass and yaw inertia
//   front_stiffness_factor = 1.0
//   rear_stiffness_factor = 1.0
//   driven_axle = "both"              # or front, rear
//   tyre = "linear"                   # or saturating
//   mu = 0.9
//   steering_lag = 0.0                # time constants [s]
//   acceleration_lag = 0.0
//   steering_rate = 0.7               # default: unlimited [rad/s]
//   acceleration_rate = 20.0          # default: unlimited [m/s³]
//   delay_cycles = 0                  # from a command to the actuators
//   steering_offset = 0.0             # the wheels stand at the measured angle plus this [rad]
//   bank = 0.0                        # inclination of the road, positive if it falls to the left [rad]
//   slope = 0.0                       # positive uphill [rad]
//   wind = {from = 2.0, until = 4.0, lateral_acceleration = 1.5}  # times [s], left positive [m/s²]; default: none
//   [sensors]                         # standard deviations
//   position = 0.0                    # [m]
//   speed = 0.0                       # [m/s]
//   heading = 0.0                     # [rad]
//   yaw_rate = 0.0                    # [rad/s]
//   [driver]                          # times since the start [s]
//   engage_at = 0.0
//   disengage_at = 30.0               # default: never; so are the next two
//   brake_at = 30.0
//   steering_override_at = 30.0
//   [expect]                          # see sim/summary.hpp; only `completed` is judged if its key is missing
//   completed = true
//   max_infeasible_steps = 0
//   min_clearance_m = 0.0
//   min_road_margin_m = 0.0
//   max_rms_lateral_error_m = 0.5
//   max_deadline_misses = 0
//   max_speed_excess_mps = 0.5        # over the route's target speed
//   max_rms_steering_rate = 0.2       # of the commands [rad/s]
//   max_p99_steering_rate = 0.5
//   max_rms_jerk = 2.0                # of the commands [m/s³]
//   max_p99_jerk = 8.0
//   max_free_standstill_s = 3.0       # at a time, though the way is free (sim/free_way.hpp)
//   max_end_overshoot_m = 0.3         # past the route's end; with this key or the next one, the drive goes on after the
//   max_end_gap_m = 0.3               # end until the vehicle stands. Before the end, at the end of the drive
//   max_mode_changes = 0
//   max_safe_stops = 0
//   min_time_to_collision_s = 1.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "control/road/road_edges.hpp"
#include "control/road/route.hpp"
#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"
#include "sim/actuator.hpp"
#include "sim/driver.hpp"
#include "sim/plant.hpp"
#include "sim/route_motion.hpp"
#include "sim/sensors.hpp"

namespace sim {

// Bounds of the map (paper, tab:MPCPar) [m].
inline constexpr double kMapMinX = -1.0;
inline constexpr double kMapMaxX = 1500.0;
inline constexpr double kMapMinY = -600.0;
inline constexpr double kMapMaxY = 800.0;

inline constexpr double kCycleTime = 0.05;  // t_s (paper, tab:VarPar) [s]

// End stops of the actuators: the limits of a vehicle, wider than those of a controller.
inline constexpr double kSteeringStop = 0.65;          // [rad]
inline constexpr double kHardestBraking = -9.81;       // [m/s²]
inline constexpr double kStrongestAcceleration = 4.0;  // [m/s²]

struct Expectations {
  bool completed = true;
  std::optional<int> max_infeasible_steps;
  std::optional<double> min_clearance_m;
  std::optional<double> min_road_margin_m;
  std::optional<double> max_rms_lateral_error_m;
  std::optional<int> max_deadline_misses;
  std::optional<double> max_speed_excess_mps;
  std::optional<double> max_rms_steering_rate;
  std::optional<double> max_p99_steering_rate;
  std::optional<double> max_rms_jerk;
  std::optional<double> max_p99_jerk;
  std::optional<double> max_free_standstill_s;
  std::optional<double> max_end_overshoot_m;
  std::optional<double> max_end_gap_m;
  std::optional<int> max_mode_changes;
  std::optional<int> max_safe_stops;
  std::optional<double> min_time_to_collision_s;
};

struct Scenario {
  Scenario(control::Route path, const control::RoadEdges& edges) : route(std::move(path)), road(edges) {}

  // Sets `initial` and `initial_delta`: on the route at `along` [m] in steady cornering at `speed` [m/s], so that the
  // vehicle's velocity, not its axis, points along the road; then moved to the left by `lateral` [m] and rotated by
  // `heading` [rad].
  void PlaceVehicle(double along, double speed, double lateral = 0.0, double heading = 0.0);

  std::string name;
  std::string description;
  std::uint64_t seed = 1;
  std::optional<double> duration;
  std::filesystem::path daemon_config;  // empty if the file names none

  control::Route route;
  control::RoadEdges road;
  std::vector<control::Obstacle> obstacles;  // at the start
  std::map<int, double> appears_at;          // time since start [s] by obstacle id; none: perceived at once
  std::map<int, double> disappears_at;       // likewise; none: never
  std::map<int, RouteMotion> motions;        // by obstacle id; none: constant velocity in the map

  PlantParameters plant;
  control::Footprint footprint;
  ActuatorParameters steering;
  ActuatorParameters acceleration;
  SensorParameters sensors;
  control::State initial = control::State::Zero();
  double initial_delta = 0.0;  // steering angle for the route's curvature at the start [rad]
  DriverPlan driver;
  Expectations expect;
};

// Throws config::ConfigError, which names file, line, key, value and what is allowed.
[[nodiscard]] Scenario LoadScenario(const std::filesystem::path& file);

}  // namespace sim
