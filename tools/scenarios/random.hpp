// Random numbers that are the same with any standard library: the C++ standard specifies the engines exactly, but not
// the distributions.
#pragma once

#include <cstdint>
#include <random>

namespace tools {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  // A number in [low, high).
  [[nodiscard]] double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }
  // A whole number in low..high; practically uniform over a small range.
  [[nodiscard]] int Integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  [[nodiscard]] bool Chance(double probability) { return Uniform(0.0, 1.0) < probability; }
  [[nodiscard]] double Sign() { return Chance(0.5) ? 1.0 : -1.0; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace tools
