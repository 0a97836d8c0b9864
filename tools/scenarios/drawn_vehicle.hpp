// The vehicle of a random scenario: a rectangle on four wheels with saturating tyres, which differs from the controller's
// model.
#pragma once

#include <string>

#include "sim/scenario.hpp"
#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

// The vehicle's footprint in every scenario.
inline constexpr control::Footprint kVehicleFootprint{.front = 1.95, .rear = 2.30, .half_width = 0.90};

struct DrawnVehicle {
  double mu = 0.0;           // friction coefficient of the road
  double mass_factor = 1.0;  // of mass and yaw inertia
  int delay_cycles = 0;
  double steering_lag = 0.0;      // [s]
  double acceleration_lag = 0.0;  // [s]
  double noise = 0.0;             // of all sensors: 1: 5 cm, 5 cm/s, 4 mrad and 10 mrad/s
};

// Draws a vehicle from a source of numbers: Random or PointReader.
template <typename Source>
[[nodiscard]] DrawnVehicle DrawVehicle(Source& source, const Interval& mu) {
  DrawnVehicle vehicle;
  vehicle.mu = source.Uniform(mu.low, mu.high);
  vehicle.mass_factor = source.Uniform(0.8, 1.2);
  vehicle.delay_cycles = source.Integer(0, 1);
  vehicle.steering_lag = source.Uniform(0.0, 0.06);
  vehicle.acceleration_lag = source.Uniform(0.0, 0.15);
  vehicle.noise = source.Uniform(0.0, 1.0);
  return vehicle;
}

// Sets footprint, plant, actuators and sensors.
void Equip(const DrawnVehicle& vehicle, sim::Scenario& scenario);

// "mass x 1.12, steering lag 25 ms, delay 1 cycle, noise 29 %"
[[nodiscard]] std::string Describe(const DrawnVehicle& vehicle);

}  // namespace tools
