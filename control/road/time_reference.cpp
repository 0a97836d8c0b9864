#include "control/road/time_reference.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace control {

TimeReference::TimeReference(std::span<const Eigen::Vector2d> points, double t_s)
    : z_(points.size()), t_s_(t_s) {
  if (!(t_s > 0.0))
    throw std::invalid_argument("reference: t_s = " + std::to_string(t_s) + " must be positive");
  if (points.size() < 2) throw std::invalid_argument("reference: needs at least two points");
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!points[k].allFinite()) {
      throw std::invalid_argument("reference: point " + std::to_string(k) + " is not finite");
    }
  }
  const std::size_t last = points.size() - 1;
  for (std::size_t k = 0; k < last; ++k) {
    const Eigen::Vector2d step = points[k + 1] - points[k];
    if (step.norm() < 1e-9) {
      throw std::invalid_argument("reference: points " + std::to_string(k) + " and " + std::to_string(k + 1) +
                                  " coincide");
    }
    const double psi = std::atan2(step.y(), step.x());
    State& z = z_[k];
    z[kX] = points[k].x();
    z[kY] = points[k].y();
    z[kPsi] = k == 0 ? psi : z_[k - 1][kPsi] + WrapAngle(psi - z_[k - 1][kPsi]);
    z[kUpsilon] = (std::cos(z[kPsi]) * step.x() + std::sin(z[kPsi]) * step.y()) / t_s;
    z[kNu] = (-std::sin(z[kPsi]) * step.x() + std::cos(z[kPsi]) * step.y()) / t_s;
  }
  z_[last] = z_[last - 1];
  z_[last][kX] = points[last].x();
  z_[last][kY] = points[last].y();
  for (std::size_t k = 0; k < last; ++k) z_[k][kOmega] = (z_[k + 1][kPsi] - z_[k][kPsi]) / t_s;
  z_[last][kOmega] = 0.0;
}

void TimeReference::Window(int k, std::span<State> out) const {
  const int last = size() - 1;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const int index = k + static_cast<int>(i);
    out[i] = z_[static_cast<std::size_t>(std::min(index, last))];
    if (index > last) {
      const double distance = (index - last) * t_s_ * out[i][kUpsilon];
      out[i][kX] += distance * std::cos(out[i][kPsi]);
      out[i][kY] += distance * std::sin(out[i][kPsi]);
    }
  }
}

}  // namespace control
