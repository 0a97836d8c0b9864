#include "control/estimation/disturbance_estimator.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "control/estimation/axle_load.hpp"
#include "control/vehicle/discrete_model.hpp"

namespace control {
namespace {

constexpr double kLongestStep = 0.05;  // of the model [s]

DisturbanceVector AsVector(const Disturbance& d) {
  return {d.delta_0, d.a_y, d.a_x, d.stiffness_factor};
}

Disturbance FromVector(const DisturbanceVector& d) {
  return {.delta_0 = d[kSteeringOffset],
          .a_y = d[kLateral],
          .a_x = d[kLongitudinal],
          .stiffness_factor = d[kStiffness]};
}

}  // namespace

DisturbanceEstimator::DisturbanceEstimator(const VehicleParameters& vehicle,
                                           const EstimatorSettings& settings)
    : vehicle_(vehicle), settings_(settings), grip_(vehicle, settings.mu) {
  Reset();
}

void DisturbanceEstimator::Reset() {
  begun_ = false;
  disturbance_ = {};
  grip_.Reset();
  P_.setZero();
  P_.diagonal().tail<kDisturbances>() = settings_.unknown.cwiseAbs2();
}

DisturbanceVector DisturbanceEstimator::Uncertainty() const {
  return P_.diagonal().tail<kDisturbances>().cwiseSqrt();
}

void DisturbanceEstimator::Update(const State& z, const Input& u, double dt) {
  if (!z.allFinite() || !u.allFinite()) return;
  const bool gap = !begun_ || !(dt > 0.0) || dt > settings_.longest_gap;
  if (gap) {
    grip_.Restart();
  } else {
    grip_.Update(measured_, z, 0.5 * (u_ + u), disturbance_, dt);
  }
  if (gap || rejected_ >= settings_.most_rejected) {
    Begin(z);
  } else {
    const Input mean = 0.5 * (u_ + u);
    observable_ = Observable(mean);
    const double steps = std::ceil(dt / kLongestStep - 1e-6);
    for (int i = 0; i < static_cast<int>(steps); ++i) Predict(mean, u - u_, dt / steps);
    Correct(z);
  }
  measured_ = z;
  u_ = u;
}

void DisturbanceEstimator::Begin(const State& z) {
  begun_ = true;
  rejected_ = 0;
  z_ = z;
  P_.topRows<kStates>().setZero();
  P_.leftCols<kStates>().setZero();
  P_.diagonal().head<kStates>() = settings_.noise.cwiseAbs2();
}

DisturbanceVector DisturbanceEstimator::Observable(const Input& u) const {
  const double speed = z_[kUpsilon];
  if (speed < settings_.standstill) return DisturbanceVector::Zero();
  if (speed < settings_.slow) return {0.0, 0.0, 1.0, 0.0};
  const double lateral = std::abs(speed * z_[kOmega] - disturbance_.a_y);
  const double used = std::max(lateral, LinearDemand(vehicle_, z_, u, disturbance_).cwiseAbs().maxCoeff());
  if (std::hypot(used, TyreDemand(vehicle_, u[kAcceleration])) >
      settings_.linear_share * grip_.limit() * kGravity) {
    return DisturbanceVector::Zero();
  }
  const bool cornering = speed > BlendedModel::kUpsilon2 && lateral > settings_.least_cornering;
  return {1.0, 1.0, 1.0, cornering ? 1.0 : 0.0};
}

void DisturbanceEstimator::Predict(const Input& u, const Input& change, double h) {
  const DiscreteModel model(BlendedModel(vehicle_, disturbance_), h);
  const LinearModel linear = model.Expand(z_, u).linear;
  const State next = model.Step(z_, u);
  // δ_0 and a_x act as the inputs do. The step is linear in a_y, and smooth in the stiffness.
  constexpr double kDifference = 1e-4;
  const auto by = [&](int index) -> State {
    DisturbanceVector d = AsVector(disturbance_);
    d[index] += kDifference;
    return (DiscreteModel(BlendedModel(vehicle_, FromVector(d)), h).Step(z_, u) - next) / kDifference;
  };
  Covariance Phi = Covariance::Identity();
  Phi.topLeftCorner<kStates, kStates>() = linear.A;
  Phi.col(kStates + kSteeringOffset).head<kStates>() = linear.B.col(kDelta);
  Phi.col(kStates + kLongitudinal).head<kStates>() = linear.B.col(kAcceleration);
  Phi.col(kStates + kLateral).head<kStates>() = by(kLateral);
  Phi.col(kStates + kStiffness).head<kStates>() = by(kStiffness);

  const Covariance moved = Phi * P_;
  P_.noalias() = moved * Phi.transpose();
  for (int j = 0; j < kInputs; ++j) {
    const State unknown = settings_.input_share * change[j] * linear.B.col(j);
    P_.topLeftCorner<kStates, kStates>().noalias() += unknown * unknown.transpose();
  }
  P_.diagonal().head<kStates>() += h * settings_.model_rate.cwiseAbs2();
  P_.diagonal().tail<kDisturbances>() += h * settings_.walk.cwiseAbs2().cwiseProduct(observable_);
  z_ = next;
}

// Joseph's form holds for any gain, also for one whose rows of frozen disturbances are zero.
void DisturbanceEstimator::Correct(const State& measured) {
  using Square = Eigen::Matrix<double, kStates, kStates>;
  const State R = settings_.noise.cwiseAbs2();
  Square S = P_.topLeftCorner<kStates, kStates>();
  S.diagonal() += R;
  const Eigen::LLT<Square> factor(S);
  State error = measured - z_;
  error[kPsi] = WrapAngle(error[kPsi]);
  if (!(error.dot(factor.solve(error)) <= settings_.gate)) {
    ++rejected_;
    return;
  }
  rejected_ = 0;
  Eigen::Matrix<double, kAll, kStates> K = factor.solve(P_.topRows<kStates>()).transpose();
  for (int j = 0; j < kDisturbances; ++j) K.row(kStates + j) *= observable_[j];
  const Column step = K * error;
  z_ += step.head<kStates>();
  disturbance_ = FromVector((AsVector(disturbance_) + step.tail<kDisturbances>())
                                .cwiseMax(settings_.least)
                                .cwiseMin(settings_.greatest));
  Covariance rest = Covariance::Identity();
  rest.leftCols<kStates>() -= K;
  const Covariance left = rest * P_;
  P_.noalias() = left * rest.transpose();
  P_.noalias() += K * R.asDiagonal() * K.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

}  // namespace control
