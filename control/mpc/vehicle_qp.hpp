// The quadratic program of the controllers. Its state holds the vehicle's state and the previous input, so that the
// rate limits are rows of a single stage.
#pragma once

#include <functional>

#include "control/vehicle/types.hpp"

namespace control {

template <int kNx, int kNu>
struct OcpQp;
template <int kNx, int kNu>
struct OcpQpPoint;
template <int kNx, int kNu>
class OcpQpSolver;

inline constexpr int kPreviousInput = kStates;  // index of u_{k−1} in the QP's state

using VehicleQp = OcpQp<kStates + kInputs, kInputs>;
using VehicleQpPoint = OcpQpPoint<kStates + kInputs, kInputs>;
using VehicleQpSolver = OcpQpSolver<kStates + kInputs, kInputs>;
using QpState = Eigen::Vector<double, kStates + kInputs>;

using QpObserver = std::function<void(const VehicleQp&)>;

}  // namespace control
