#include "loop/controller_tables.hpp"

namespace loop {
namespace {

const Bounds kNotNegative{0.0, 1e12, ""};
const Bounds kPositive{1e-9, 1e12, ""};

// The file has the full width, Config half of it.
ConfigKey Width() {
  const Config defaults;
  return {.name = "width",
          .default_value = key_detail::Text(2.0 * defaults.affine.footprint.half_width),
          .allowed = key_detail::Allowed(Bounds{0.0, 5.0, "m"}),
          .sentence = "Width of the vehicle",
          .read = [](const config::TomlTable& table, Config& config) {
            double& half = config.affine.footprint.half_width;
            half = 0.5 * table.NumberOr("width", 2.0 * half, {0.0, 5.0}, "m");
          }};
}

}  // namespace

ConfigTable ControllerTable() {
  return {
      "controller",
      "All keys but _kind_ and _offset_free_ are settings of the paper's controllers.",
      {
          ChoiceKey(
              "kind", ControllerNames(),
              [](const Config& c) { return static_cast<std::size_t>(c.controller); },
              [](Config& c, std::size_t i) { c.controller = static_cast<ControllerKind>(i); },
              "_lpv-affine_ is set in [lpv_affine]. The paper's controllers are _lpv_, with the scheduling "
              "trust "
              "region, and _lpv-standard_, without it. The nonlinear controllers _nmpc_ (the paper's) and "
              "_nmpc-affine_ (the problem of lpv-affine) are for *lpvmpc*(1) alone; the daemon refuses them"),
          Key(
              "offset_free", [](Config& c) { return &c.offset_free; }, {},
              "Whether _lpv-affine_ and _nmpc-affine_ estimate steering offset, bank, wind, slope and tyre "
              "stiffness from the measured states and counter them, so that they leave no lasting error"),
          Key(
              "horizon", [](Config& c) { return &c.mpc.horizon; }, {2, 100, ""},
              "Number of steps of the horizon, N"),
          ChoiceKey(
              "discretisation", {"euler", "zero-order-hold"},
              [](const Config& c) {
                return static_cast<std::size_t>(c.mpc.discretisation != control::Discretisation::kEuler);
              },
              [](Config& c, std::size_t i) {
                c.mpc.discretisation =
                    i == 0 ? control::Discretisation::kEuler : control::Discretisation::kZeroOrderHold;
              },
              "Discretisation of the model. The paper's is Euler's method, which _nmpc_ always uses"),
          Key(
              "Q", [](Config& c) { return &c.mpc.Q; }, kNotNegative, "Weights of the error in X Y υ ν ψ ω"),
          OptionalKey(
              "P", [](Config& c) { return &c.P; }, kNotNegative, "Q",
              "Weights of the error at the last step"),
          Key(
              "R", [](Config& c) { return &c.mpc.R; }, kPositive, "Weights of steering and acceleration"),
          Key(
              "E_p", [](Config& c) { return &c.mpc.E_p; }, kPositive, "Weights of the trust region's slacks"),
          Key(
              "trust_radius", [](Config& c) { return &c.mpc.trust_radius; }, kPositive,
              "Radii of the trust region for υ [m/s], ν [m/s], ψ [rad] and δ [rad]"),
          Key(
              "obstacle_margin", [](Config& c) { return &c.mpc.obstacle_margin; }, {0.0, 5.0, "m"},
              "Margin by which obstacles are enlarged"),
          Key(
              "z_min", [](Config& c) { return &c.mpc.z_min; }, {},
              "Lower bounds of X Y υ ν ψ ω; the bound of ψ is relative to the reference"),
          Key(
              "z_max", [](Config& c) { return &c.mpc.z_max; }, {},
              "Upper bounds, each above its lower bound"),
      }};
}

ConfigTable LpvAffineTable() {
  return {"lpv_affine",
          "Settings of _lpv-affine_, the default controller.",
          {
              Key(
                  "horizon", [](Config& c) { return &c.affine.horizon; }, {2, 100, ""},
                  "Number of steps of the horizon, N"),
              Key(
                  "Q", [](Config& c) { return &c.affine.Q; }, kNotNegative,
                  "Weights of the error in X Y υ ν ψ ω"),
              Key(
                  "terminal", [](Config& c) { return &c.affine.terminal; }, {0.0, 1e6, ""},
                  "Factor by which the weights of the last step exceed Q"),
              Key(
                  "R", [](Config& c) { return &c.affine.R; }, kPositive,
                  "Weights of the difference of steering and acceleration from the reference's"),
              Key(
                  "R_rate", [](Config& c) { return &c.affine.R_rate; }, kPositive,
                  "Weights of the change of steering and acceleration in a step"),
              ChoiceKey(
                  "trust_region", {"adaptive", "fixed", "none"},
                  [](const Config& c) -> std::size_t {
                    return !c.affine.trust_region ? 2 : (c.affine.adapt_trust_region ? 0 : 1);
                  },
                  [](Config& c, std::size_t i) {
                    c.affine.adapt_trust_region = i == 0;
                    c.affine.trust_region = i < 2;
                  },
                  "Whether the radii of the trust region follow the error of the last prediction"),
              Key(
                  "trust_radius", [](Config& c) { return &c.affine.trust_radius; }, kPositive,
                  "Radii of the trust region for υ [m/s], ν [m/s], ψ [rad] and δ [rad]"),
              Key(
                  "mu", [](Config& c) { return &c.affine.mu; }, {0.05, 1.5, ""},
                  "Friction coefficient of the road"),
              Key(
                  "friction_share", [](Config& c) { return &c.affine.friction_share; }, {0.1, 1.0, ""},
                  "Share of the friction that a plan may use"),
              Key(
                  "obstacle_margin", [](Config& c) { return &c.affine.obstacle_margin; }, {0.0, 5.0, "m"},
                  "Distance from obstacles, where there is room for it"),
              Key(
                  "road_margin", [](Config& c) { return &c.affine.road_margin; }, {0.0, 5.0, "m"},
                  "Distance from the edges of the road, where there is room for it"),
              Key(
                  "stop_gap", [](Config& c) { return &c.affine.stop_gap; }, {0.0, 50.0, "m"},
                  "Distance at which the vehicle stops before an obstacle that it cannot pass"),
              Key(
                  "max_steering_rate", [](Config& c) { return &c.max_steering_rate; }, {0.01, 10.0, "rad/s"},
                  "Largest rate of the steering angle in a plan"),
              Key(
                  "max_jerk", [](Config& c) { return &c.max_jerk; }, {0.1, 400.0, "m/s^3"},
                  "Largest jerk in a plan"),
              Key(
                  "iterations", [](Config& c) { return &c.affine.iterations; }, {1, 20, ""},
                  "Number of QPs solved in a cycle while there is time, each linearised about the plan of "
                  "the one before"),
              Key(
                  "lateral_acceleration", [](Config& c) { return &c.speed.lateral; }, {0.1, 13.0, "m/s^2"},
                  "Lateral acceleration to which curves are slowed down"),
              Key(
                  "acceleration", [](Config& c) { return &c.speed.acceleration; }, {0.1, 13.0, "m/s^2"},
                  "Acceleration towards a higher target speed"),
              Key(
                  "deceleration", [](Config& c) { return &c.speed.deceleration; }, {0.1, 13.0, "m/s^2"},
                  "Deceleration towards a lower target speed and the end of the route"),
          }};
}

ConfigTable VehicleTable() {
  const std::string ends = ". The paper's controllers take the vehicle for a point";
  return {"vehicle",
          "The controllers' model of the vehicle.",
          {
              Key(
                  "m", [](Config& c) { return &c.vehicle.m; }, {100.0, 1e5, "kg"}, "Mass"),
              Key(
                  "I_z", [](Config& c) { return &c.vehicle.I_z; }, {10.0, 1e6, "kg m^2"}, "Yaw inertia"),
              Key(
                  "l_f", [](Config& c) { return &c.vehicle.l_f; }, {0.1, 20.0, "m"},
                  "Distance from the centre of gravity to the front axle"),
              Key(
                  "l_r", [](Config& c) { return &c.vehicle.l_r; }, {0.1, 20.0, "m"},
                  "Distance from the centre of gravity to the rear axle"),
              Key(
                  "C_alpha_f", [](Config& c) { return &c.vehicle.C_alpha_f; }, {1e3, 1e7, "N/rad"},
                  "Cornering stiffness of one front tyre"),
              Key(
                  "C_alpha_r", [](Config& c) { return &c.vehicle.C_alpha_r; }, {1e3, 1e7, "N/rad"},
                  "Cornering stiffness of one rear tyre"),
              ChoiceKey(
                  "driven_axle", {"both", "front", "rear"},
                  [](const Config& c) { return static_cast<std::size_t>(c.vehicle.driven); },
                  [](Config& c, std::size_t i) { c.vehicle.driven = static_cast<control::DrivenAxle>(i); },
                  "The axle that drives. Its tyres alone give the acceleration, so that on a slippery road "
                  "_lpv-affine_ and _nmpc-affine_ demand less of it, least of all in a bend"),
              Key(
                  "front", [](Config& c) { return &c.affine.footprint.front; }, {0.0, 20.0, "m"},
                  "Distance from the centre of gravity to the front end" + ends),
              Key(
                  "rear", [](Config& c) { return &c.affine.footprint.rear; }, {0.0, 20.0, "m"},
                  "Distance from the centre of gravity to the rear end"),
              Width(),
          }};
}

}  // namespace loop
