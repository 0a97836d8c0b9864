// Estimates what acts on the vehicle besides its inputs (control/vehicle/disturbance.hpp) from the measured states, so
// that the controller's model has no lasting error and tracks without offset (Pannocchia and Rawlings, AIChE Journal
// 49(2), 2003). It is an extended Kalman filter of the vehicle's state and d = [δ_0 a_y a_x c], a random walk:
//
//   z_{k+1} = F(z_k, u_k; d_k) + w      F of control/vehicle/discrete_model.hpp
//   d_{k+1} = d_k + v,   y_k = z_k + n
//
// What tells the disturbances apart, with ν and ω both measured:
//   a_x   the change of υ that is neither a nor ων
//   δ_0   a yaw moment at straight wheels: ω̇ contains l_f C_αf δ_0, to which a_y contributes nothing
//   a_y   a change of ν, ν̇ + ωυ − (tyre forces), without a yaw moment; the vehicle holds it by sideslip alone
//   c     sideslip per lateral acceleration. In a bend that lasts, a_y does the same, and only coming and going bends
//         tell them apart.
// So both δ_0 and a_y bend a straight path, but only a_y turns the vehicle's axis against the path.
//
// What is not observable is frozen: all below 0.5 m/s, all but a_x below 3 m/s, c without lateral acceleration, and
// everything while the tyres are no longer linear. A measurement that the prediction rules out changes nothing; after
// several in succession the vehicle's state begins anew from the measurement, and the disturbances are kept.
//
// With a sensor noise of 0.02 m, 0.02 m/s, 0.0015 rad and 0.002 rad/s, the standard deviations of δ_0, a_y and a_x at
// 25 m/s are 0.004°, 0.03 m/s² and 0.02 m/s², with three times that noise three times as much. From nothing, δ_0 is
// found in half a second, bank and slope in two; a gust is followed more slowly, two thirds of it in four seconds.
//
//   DisturbanceEstimator estimator(vehicle);
//   estimator.Update(z, u, dt);  // once for each measured state
//   … = estimator.disturbance();
#pragma once

#include "control/estimation/estimator_settings.hpp"
#include "control/estimation/grip_estimator.hpp"
#include "control/vehicle/disturbance.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// Nothing is allocated.
class DisturbanceEstimator {
 public:
  explicit DisturbanceEstimator(const VehicleParameters& vehicle, const EstimatorSettings& settings = {});

  // Takes the state `z` and the input `u` [δ a], both measured `dt` [s] after those of the last call. The time since
  // then is bridged by the mean of both inputs. The estimate is kept, but not improved, if `dt` is not positive or is
  // longer than `longest_gap`, and by the first call. Values that are not finite are ignored.
  void Update(const State& z, const Input& u, double dt);
  // Forgets everything.
  void Reset();

  [[nodiscard]] const Disturbance& disturbance() const { return disturbance_; }
  // Friction coefficient that plans may count on: that of the settings, or less where the tyres have been felt to slide
  // (grip_estimator.hpp).
  [[nodiscard]] double mu_limit() const { return grip_.limit(); }
  // Standard deviations of the estimate, as the filter sees them.
  [[nodiscard]] DisturbanceVector Uncertainty() const;
  // The vehicle's state as filtered; ψ may include full turns.
  [[nodiscard]] const State& z() const { return z_; }
  [[nodiscard]] int rejected() const { return rejected_; }  // measurements ruled out in succession

 private:
  static constexpr int kAll = kStates + kDisturbances;
  using Covariance = Eigen::Matrix<double, kAll, kAll>;
  using Column = Eigen::Matrix<double, kAll, 1>;

  void Begin(const State& z);
  void Predict(const Input& u, const Input& change, double h);
  void Correct(const State& measured);
  // 1 for each disturbance that can be observed now, otherwise 0.
  [[nodiscard]] DisturbanceVector Observable(const Input& u) const;

  VehicleParameters vehicle_;
  EstimatorSettings settings_;
  bool begun_ = false;
  State z_ = State::Zero();
  State measured_ = State::Zero();  // the last measurement
  Input u_ = Input::Zero();         // measured with the last state
  Disturbance disturbance_;
  DisturbanceVector observable_ = DisturbanceVector::Zero();
  Covariance P_ = Covariance::Zero();
  int rejected_ = 0;
  GripEstimator grip_;
};

}  // namespace control
