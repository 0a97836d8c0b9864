#include "tools/scenarios/drawn_vehicle.hpp"

#include <fmt/format.h>

namespace tools {

void Equip(const DrawnVehicle& vehicle, sim::Scenario& scenario) {
  scenario.footprint = kVehicleFootprint;
  sim::PlantParameters& plant = scenario.plant;
  plant.tyre = sim::Tyre::kSaturating;
  plant.mu = vehicle.mu;
  plant.vehicle.m *= vehicle.mass_factor;
  plant.vehicle.I_z *= vehicle.mass_factor;
  scenario.steering = {.time_constant = vehicle.steering_lag,
                       .rate = 0.7,
                       .min = -sim::kSteeringStop,
                       .max = sim::kSteeringStop,
                       .delay_cycles = vehicle.delay_cycles};
  scenario.acceleration = {.time_constant = vehicle.acceleration_lag,
                           .rate = 20.0,
                           .min = sim::kHardestBraking,
                           .max = sim::kStrongestAcceleration,
                           .delay_cycles = vehicle.delay_cycles};
  scenario.sensors = {.position = 0.05 * vehicle.noise,
                      .speed = 0.05 * vehicle.noise,
                      .heading = 0.004 * vehicle.noise,
                      .yaw_rate = 0.01 * vehicle.noise};
}

std::string Describe(const DrawnVehicle& vehicle) {
  return fmt::format("mass x {:.2f}, steering lag {:.0f} ms, delay {} cycle{}, noise {:.0f} %",
                     vehicle.mass_factor, 1e3 * vehicle.steering_lag, vehicle.delay_cycles,
                     vehicle.delay_cycles == 1 ? "" : "s", 100.0 * vehicle.noise);
}

}  // namespace tools
