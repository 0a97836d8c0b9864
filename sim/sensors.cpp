#include "sim/sensors.hpp"

#include <cmath>
#include <numbers>

namespace sim {

// Box-Muller transform; std::normal_distribution differs between standard libraries.
double Sensors::Normal() {
  const auto uniform = [this] { return (static_cast<double>(random_() >> 11) + 0.5) * 0x1.0p-53; };
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

control::State Sensors::Measure(const control::State& truth) {
  control::State measured = truth;
  measured[control::kX] += parameters_.position * Normal();
  measured[control::kY] += parameters_.position * Normal();
  measured[control::kUpsilon] += parameters_.speed * Normal();
  measured[control::kNu] += parameters_.speed * Normal();
  measured[control::kPsi] += parameters_.heading * Normal();
  measured[control::kOmega] += parameters_.yaw_rate * Normal();
  return measured;
}

}  // namespace sim
