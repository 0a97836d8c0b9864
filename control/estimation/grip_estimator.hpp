// Feels the road's friction: where a tyre gives clearly less than its slip or its brake demands, the force that it does
// give bounds the friction coefficient.
//
//   lateral, each axle   the side force from ν̇ + υω and ω̇, against that of linear tyres at the measured slip, while that rises. By the
//                        brush model, their ratio tells how near to sliding the axle is, and so its μ.
//   longitudinal         the deceleration, against the one that the brakes demand; from then on the tyres slide. An acceleration
//                        below the demanded one shows nothing, since an engine may be too weak for it.
//
// Only a clear shortfall that lasts counts, so neither noise, nor the curvature of an ordinary tyre's characteristic,
// nor a stiffness that differs from the model lowers the bound. It falls at once and rises slowly, or to what the tyres
// do give, never above the assumed coefficient.
#pragma once

#include "control/estimation/axle_load.hpp"
#include "control/vehicle/disturbance.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// Nothing is allocated.
class GripEstimator {
 public:
  // `mu`: assumed friction coefficient.
  GripEstimator(const VehicleParameters& vehicle, double mu) : vehicle_(vehicle), mu_(mu), limit_(mu) {}

  // Takes the states `before` and `after`, measured `dt` > 0 [s] apart, and the mean input between them.
  void Update(const State& before, const State& after, const Input& u, const Disturbance& disturbance,
              double dt);
  // Begins anew after a gap; the bound is kept.
  void Restart();
  // Forgets everything.
  void Reset();

  // Friction coefficient that plans may count on [1].
  [[nodiscard]] double limit() const { return limit_; }

 private:
  [[nodiscard]] double Given() const;
  [[nodiscard]] double FeltLaterally() const;
  [[nodiscard]] double Along(Axle axle) const;
  [[nodiscard]] double FeltWhenBraking() const;

  VehicleParameters vehicle_;
  double mu_;
  double limit_;
  // Low-pass filtered [m/s²].
  Axles demand_ = Axles::Zero(), response_ = Axles::Zero();
  Axles before_ = Axles::Zero();  // the last demand_
  double braking_ = 0.0, slowing_ = 0.0;
  double speed_ = 0.0;     // [m/s]
  double demanded_ = 0.0;  // deceleration by the brakes [m/s²]
  double given_ = 0.0;     // coefficient that the tyres used lately
  int lasting_ = 0;        // measurements in succession that show a shortfall
};

}  // namespace control
