#include "control/vehicle_model.hpp"

#include <cmath>

namespace control {

State VehicleModel::Derivative(const State& z, const Input& u) const {
  const auto& p = parameters_;
  const double upsilon = z[kUpsilon], nu = z[kNu], psi = z[kPsi], omega = z[kOmega], delta = u[kDelta];
  const double F_yf = p.C_alpha_f * (delta - (nu + p.l_f * omega) / upsilon);
  const double F_yr = p.C_alpha_r * (p.l_r * omega - nu) / upsilon;
  State f;
  f[kX] = upsilon * std::cos(psi) - nu * std::sin(psi);
  f[kY] = upsilon * std::sin(psi) + nu * std::cos(psi);
  f[kUpsilon] = omega * nu + u[kAcceleration];
  f[kNu] = -omega * upsilon + 2.0 / p.m * (F_yf * std::cos(delta) + F_yr);
  f[kPsi] = omega;
  f[kOmega] = 2.0 / p.I_z * (p.l_f * F_yf - p.l_r * F_yr);
  return f;
}

}  // namespace control
