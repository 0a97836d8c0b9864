// Random numbers that are the same on every machine.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

namespace control::testing {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }
  int Integer(int low, int high) {  // low..high
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool Chance(double probability) { return Uniform(0.0, 1.0) < probability; }

  // Entries uniform in [-magnitude, magnitude].
  template <typename Matrix>
  Matrix Filled(double magnitude) {
    Matrix matrix;
    for (Eigen::Index k = 0; k < matrix.size(); ++k) matrix.data()[k] = Uniform(-magnitude, magnitude);
    return matrix;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace control::testing
