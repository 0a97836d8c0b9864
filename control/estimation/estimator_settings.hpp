// What the disturbance estimator assumes of sensors, model and disturbances. A rate is the standard deviation of a
// random walk after one second.
#pragma once

#include "control/vehicle/types.hpp"

namespace control {

// Order of the disturbances in the filter's state.
inline constexpr int kDisturbances = 4;
enum DisturbanceIndex : int { kSteeringOffset, kLateral, kLongitudinal, kStiffness };
using DisturbanceVector = Eigen::Matrix<double, kDisturbances, 1>;

struct EstimatorSettings {
  double mu = 0.7;  // assumed friction coefficient of the road

  State noise{0.06, 0.06, 0.06, 0.06, 0.005, 0.008};  // standard deviation of the sensors' noise [unit of z]
  State model_rate{0.01, 0.01, 0.03, 0.05, 0.002, 0.03};  // error of the model [unit of z]
  double input_share =
      0.3;  // share of the change of an input by which the mean between two measurements is unknown

  // δ_0 [rad], a_y [m/s²], a_x [m/s²], stiffness factor [1]
  DisturbanceVector unknown{0.02, 0.5, 0.5, 0.2};     // standard deviation before any measurement
  DisturbanceVector walk{8e-4, 0.08, 0.2, 0.04};      // rates
  DisturbanceVector least{-0.0524, -2.0, -3.0, 0.3};  // bounds: 3° of δ_0
  DisturbanceVector greatest{0.0524, 2.0, 3.0, 1.5};

  double standstill = 0.5;    // [m/s]; below it the brake holds whatever the slope, and nothing is observable
  double slow = 3.0;          // [m/s]; below it only a_x is observable
  double linear_share = 0.6;  // share of the friction up to which tyres are taken for linear
  double least_cornering = 1.5;  // lateral acceleration from which the stiffness shows [m/s²]

  double gate =
      60.0;  // largest squared normalised error of a prediction (6 degrees of freedom) that is believed
  int most_rejected = 4;     // in succession; then the filter's state of the vehicle begins anew
  double longest_gap = 0.3;  // longest time between two measurements that is bridged by the model [s]
};

}  // namespace control
