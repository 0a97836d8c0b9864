#include "control/road/time_reference.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace control {

TimeReference::TimeReference(std::span<const Eigen::Vector2d> points, double t_s)
    : z_(points.size()), s_(points.size(), 0.0), t_s_(t_s) {
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
    s_[k + 1] = s_[k] + step.norm();
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

State TimeReference::At(int k) const {
  const int last = size() - 1;
  State z = z_[static_cast<std::size_t>(std::min(k, last))];
  if (k > last) {
    const double distance = (k - last) * t_s_ * z[kUpsilon];
    z[kX] += distance * std::cos(z[kPsi]);
    z[kY] += distance * std::sin(z[kPsi]);
  }
  return z;
}

double TimeReference::ArcLength(int k) const {
  const int last = size() - 1;
  const double beyond = std::max(k - last, 0) * t_s_ * z_.back()[kUpsilon];
  return s_[static_cast<std::size_t>(std::min(k, last))] + beyond;
}

void TimeReference::Window(int k, std::span<State> out) const {
  for (State& z : out) z = At(k++);
}

}  // namespace control
