#include "control/vehicle/types.hpp"

#include <cmath>
#include <numbers>

namespace control {

double WrapAngle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped == -std::numbers::pi ? std::numbers::pi : wrapped;
}

double UnwrapAngle(double angle, double near) {
  return near + WrapAngle(angle - near);
}

}  // namespace control
