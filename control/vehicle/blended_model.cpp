#include "control/vehicle/blended_model.hpp"

#include <algorithm>
#include <cmath>

namespace control {
namespace {

// The dynamic model divides by υ, so its υ is at least kUpsilon1; below that, the model has no weight.
State FastEnough(const State& z) {
  State fast = z;
  fast[kUpsilon] = std::max(z[kUpsilon], BlendedModel::kUpsilon1);
  return fast;
}

struct Weight {
  double w = 0.0;
  double slope = 0.0;  // dw/dυ
};

Weight WeightAt(double upsilon) {
  constexpr double kWidth = BlendedModel::kUpsilon2 - BlendedModel::kUpsilon1;
  const double s = std::clamp((upsilon - BlendedModel::kUpsilon1) / kWidth, 0.0, 1.0);
  return {.w = s * s * (3.0 - 2.0 * s), .slope = 6.0 * s * (1.0 - s) / kWidth};
}

}  // namespace

BlendedModel::BlendedModel(const VehicleParameters& parameters, const Disturbance& disturbance)
    : dynamic_(Disturbed(parameters, disturbance)),
      wheelbase_(parameters.l_f + parameters.l_r),
      l_r_(parameters.l_r),
      disturbance_(disturbance) {}

State BlendedModel::Dynamic(const State& fast, const Input& u, const Angles& angles) const {
  State f = dynamic_.Derivative(fast, Acting(u, disturbance_), angles);
  f[kNu] += disturbance_.a_y;
  return f;
}

State BlendedModel::Derivative(const State& z, const Input& u, const Angles& angles) const {
  return Blend(z, angles, Dynamic(FastEnough(z), u, angles), WeightAt(z[kUpsilon]).w);
}

// `dynamic` is the dynamic model's derivative at FastEnough(z).
State BlendedModel::Blend(const State& z, const Angles& angles, const State& dynamic, double w) const {
  const double upsilon = z[kUpsilon], nu = z[kNu];
  const double omega_rolling = upsilon * angles.sin_delta / (angles.cos_delta * wheelbase_);
  State f = dynamic;
  f[kX] = upsilon * angles.cos_psi - nu * angles.sin_psi;
  f[kY] = upsilon * angles.sin_psi + nu * angles.cos_psi;
  f[kNu] = w * f[kNu] + (1.0 - w) * (l_r_ * omega_rolling - nu) / kTau;
  f[kOmega] = w * f[kOmega] + (1.0 - w) * (omega_rolling - z[kOmega]) / kTau;
  return f;
}

BlendedModel::Linearisation BlendedModel::Linearise(const State& z, const Input& u,
                                                    const Angles& angles) const {
  const double upsilon = z[kUpsilon], nu = z[kNu];
  const Weight weight = WeightAt(upsilon);
  const State fast = FastEnough(z);
  const State f = Dynamic(fast, u, angles);
  const double tan_delta = angles.sin_delta / angles.cos_delta;
  const double omega_rolling = upsilon * tan_delta / wheelbase_;

  LinearModel d = dynamic_.Jacobian(fast, Acting(u, disturbance_), angles);
  d.A(kX, kPsi) = -upsilon * angles.sin_psi - nu * angles.cos_psi;
  d.A(kY, kPsi) = upsilon * angles.cos_psi - nu * angles.sin_psi;
  const auto blend = [&](int row, double arm) {
    const double kinematic = (arm * omega_rolling - z[row]) / kTau;
    const double slow = (1.0 - weight.w) / kTau;
    d.A.row(row) *= weight.w;
    d.B.row(row) *= weight.w;
    d.A(row, kUpsilon) += slow * arm * tan_delta / wheelbase_ + weight.slope * (f[row] - kinematic);
    d.A(row, row) -= slow;
    d.B(row, kDelta) += slow * arm * upsilon * (1.0 + tan_delta * tan_delta) / wheelbase_;
  };
  blend(kNu, l_r_);
  blend(kOmega, 1.0);
  return {.f = Blend(z, angles, f, weight.w), .jacobian = d};
}

}  // namespace control
