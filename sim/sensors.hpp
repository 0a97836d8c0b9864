// The vehicle's measurements of its own motion: the truth plus Gaussian noise. Quantisation is added by the bus.
#pragma once

#include <cstdint>
#include <random>

#include "control/vehicle/types.hpp"

namespace sim {

// Standard deviations, >= 0.
struct SensorParameters {
  double position = 0.0;  // X and Y [m]
  double speed = 0.0;     // υ and ν [m/s]
  double heading = 0.0;   // ψ [rad]
  double yaw_rate = 0.0;  // ω [rad/s]
};

class Sensors {
 public:
  Sensors(const SensorParameters& parameters, std::uint64_t seed) : parameters_(parameters), random_(seed) {}

  // The same seed gives the same noise with any standard library.
  [[nodiscard]] control::State Measure(const control::State& truth);

 private:
  double Normal();

  SensorParameters parameters_;
  std::mt19937_64 random_;
};

}  // namespace sim
