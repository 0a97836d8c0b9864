// Numbers read one after the other from a point of the unit cube, so that a search can vary each of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>

namespace tools {

class PointReader {
 public:
  // `coordinates`: each in [0, 1); must outlive the reader.
  explicit PointReader(std::span<const double> coordinates) : left_(coordinates) {}

  // Each reads one coordinate and throws std::out_of_range if none is left.
  // A number in [low, high).
  [[nodiscard]] double Uniform(double low, double high) { return low + (high - low) * Next(); }
  // A whole number in low..high.
  [[nodiscard]] int Integer(int low, int high) {
    return std::min(high, low + static_cast<int>(std::floor(Next() * (high - low + 1))));
  }
  [[nodiscard]] bool Chance(double probability) { return Next() < probability; }
  [[nodiscard]] double Sign() { return Chance(0.5) ? 1.0 : -1.0; }

  // A reader of the next `count` coordinates. What it leaves unread is not read by this one either, so that the meaning
  // of the coordinates after it does not depend on those in it.
  [[nodiscard]] PointReader Block(std::size_t count) {
    PointReader block(Take(count));
    return block;
  }
  [[nodiscard]] std::size_t left() const { return left_.size(); }

 private:
  [[nodiscard]] double Next() { return Take(1).front(); }
  [[nodiscard]] std::span<const double> Take(std::size_t count) {
    if (count > left_.size()) throw std::out_of_range("the point has no coordinate left");
    const std::span<const double> taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }

  std::span<const double> left_;
};

}  // namespace tools
