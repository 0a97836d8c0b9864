// A linear model of the vehicle, ż = A z + B u or z_{k+1} = A z_k + B u_k; for a nonlinear model, its Jacobian.
#pragma once

#include "control/vehicle/types.hpp"

namespace control {

struct LinearModel {
  Eigen::Matrix<double, kStates, kStates> A;
  Eigen::Matrix<double, kStates, kInputs> B;
};

}  // namespace control
