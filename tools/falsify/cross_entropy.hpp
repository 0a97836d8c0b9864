// The cross-entropy method (Rubinstein and Kroese, "The Cross-Entropy Method", 2004): looks for a point of the unit cube
// at which a function is small, by drawing generations of points and learning from the best of each.
//
// Each coordinate has a normal distribution of its own, cut off at 0 and 1; before anything is learnt, it is uniform.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/scenarios/random.hpp"

namespace tools {

class CrossEntropy {
 public:
  using Point = std::vector<double>;

  CrossEntropy(std::size_t dimensions, std::uint64_t seed) : coordinates_(dimensions), random_(seed) {}

  [[nodiscard]] Point Draw();

  // Moves mean and standard deviation of each coordinate 70 % of the way to those of `elite`; the deviation stays at
  // least 0.02. Learns nothing from fewer than two points.
  void Learn(std::span<const Point> elite);

 private:
  struct Coordinate {
    double mean = 0.5;
    double deviation = 0.0;  // 0: uniform
  };

  [[nodiscard]] double Normal();  // mean 0, standard deviation 1

  std::vector<Coordinate> coordinates_;
  Random random_;
};

}  // namespace tools
