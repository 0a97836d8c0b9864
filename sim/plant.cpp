#include "sim/plant.hpp"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

using control::Input;
using control::State;

// Below this wheel speed the brake fades out, so that it does not push backwards [m/s].
constexpr double kBrakeFade = 0.1;

double BrakeShare(double rolling_speed) {
  return std::clamp(rolling_speed / kBrakeFade, -1.0, 1.0);
}

// Brush model with one friction coefficient; `limit` is the greatest force.
double BrushForce(double stiffness, double slip, double limit) {
  const double demand = stiffness * std::tan(slip);
  const double z = std::abs(demand) / (3.0 * std::max(limit, 1e-9));
  return z < 1.0 ? demand * (1.0 - z + z * z / 3.0) : std::copysign(limit, demand);
}

}  // namespace

Plant::Plant(const PlantParameters& parameters, const State& initial)
    : parameters_(parameters), state_(initial) {
  const control::VehicleParameters& v = parameters_.vehicle;
  hubs_[kFrontLeft] = {v.l_f, 0.5 * parameters_.track_front};
  hubs_[kFrontRight] = {v.l_f, -0.5 * parameters_.track_front};
  hubs_[kRearLeft] = {-v.l_r, 0.5 * parameters_.track_rear};
  hubs_[kRearRight] = {-v.l_r, -0.5 * parameters_.track_rear};
}

double Plant::WheelAngle(const Input& u) const {
  return u[control::kDelta] + parameters_.steering_offset;
}

// The acceleration by gravity and wind, in the body frame [m/s²].
Eigen::Vector2d Plant::Pull() const {
  const Wind& wind = parameters_.wind;
  const bool blows = time_ >= wind.from && time_ < wind.until;
  return {-kGravity * std::sin(parameters_.slope),
          kGravity * std::sin(parameters_.bank) + (blows ? wind.lateral_acceleration : 0.0)};
}

std::array<double, kWheels> Plant::Loads(const State& z, const Input& u) const {
  const control::VehicleParameters& v = parameters_.vehicle;
  const double wheelbase = v.l_f + v.l_r;
  const double weight = v.m * kGravity;
  const double pitch = v.m * u[control::kAcceleration] * parameters_.height / wheelbase;
  const double front = std::clamp(weight * v.l_r / wheelbase - pitch, 0.0, weight);
  const double rear = weight - front;
  // The left wheels carry less in a left turn.
  const double roll = v.m * z[control::kUpsilon] * z[control::kOmega] * parameters_.height;
  const auto transfer = [roll](double share, double track, double axle) {
    return track > 0.0 ? std::clamp(share * roll / track, -0.5 * axle, 0.5 * axle) : 0.0;
  };
  const double front_transfer = transfer(parameters_.roll_share_front, parameters_.track_front, front);
  const double rear_transfer = transfer(1.0 - parameters_.roll_share_front, parameters_.track_rear, rear);
  return {0.5 * front - front_transfer, 0.5 * front + front_transfer, 0.5 * rear - rear_transfer,
          0.5 * rear + rear_transfer};
}

// Of the front and the rear wheels, for an acceleration of the vehicle [m/s²]; the driven wheels give all of it.
std::array<double, 2> Plant::DriveForcePerLoad(double acceleration,
                                               const std::array<double, kWheels>& loads) const {
  const control::VehicleParameters& v = parameters_.vehicle;
  const auto alone = [&](Wheel left, Wheel right) {
    return v.m * acceleration / std::max(loads[left] + loads[right], 1.0);
  };
  switch (v.driven) {
    case control::DrivenAxle::kFront:
      return {alone(kFrontLeft, kFrontRight), 0.0};
    case control::DrivenAxle::kRear:
      return {0.0, alone(kRearLeft, kRearRight)};
    case control::DrivenAxle::kBoth:
      break;
  }
  return {acceleration / kGravity, acceleration / kGravity};
}

std::array<WheelForces, kWheels> Plant::Forces(const State& z, const Input& u) const {
  const control::VehicleParameters& v = parameters_.vehicle;
  const std::array<double, kWheels> loads = Loads(z, u);
  const double brakes = std::min(u[control::kAcceleration], 0.0) / kGravity;  // force per load
  const auto drives = DriveForcePerLoad(std::max(u[control::kAcceleration], 0.0), loads);
  const double cos_delta = std::cos(WheelAngle(u));
  const double sin_delta = std::sin(WheelAngle(u));
  std::array<WheelForces, kWheels> forces;
  for (std::size_t i = 0; i < kWheels; ++i) {
    const bool front = i < kRearLeft;
    const double c = front ? cos_delta : 1.0;
    const double s = front ? sin_delta : 0.0;
    const double v_x = z[control::kUpsilon] - z[control::kOmega] * hubs_[i].y();
    const double v_y = z[control::kNu] + z[control::kOmega] * hubs_[i].x();
    const double rolling = c * v_x + s * v_y;
    const double sliding = c * v_y - s * v_x;
    const double stiffness = front ? v.C_alpha_f : v.C_alpha_r;
    WheelForces& wheel = forces[i];
    wheel.F_z = loads[i];
    wheel.slip = -std::atan2(sliding, std::max(std::abs(rolling), kSlipSpeed));
    wheel.F_x = (BrakeShare(rolling) * brakes + drives[front ? 0 : 1]) * wheel.F_z;
    if (parameters_.tyre == Tyre::kLinear) {
      wheel.F_y = stiffness * wheel.slip;
      continue;
    }
    const double grip = parameters_.mu * wheel.F_z;
    wheel.F_x = std::clamp(wheel.F_x, -grip, grip);
    wheel.F_y =
        BrushForce(stiffness, wheel.slip, std::sqrt(std::max(0.0, grip * grip - wheel.F_x * wheel.F_x)));
  }
  return forces;
}

State Plant::Derivative(const State& z, const Input& u) const {
  const control::VehicleParameters& v = parameters_.vehicle;
  const double cos_delta = std::cos(WheelAngle(u));
  const double sin_delta = std::sin(WheelAngle(u));
  const std::array<WheelForces, kWheels> forces = Forces(z, u);
  double force_x = 0.0;
  double force_y = 0.0;
  double moment = 0.0;
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double c = i < kRearLeft ? cos_delta : 1.0;
    const double s = i < kRearLeft ? sin_delta : 0.0;
    const double f_x = c * forces[i].F_x - s * forces[i].F_y;
    const double f_y = s * forces[i].F_x + c * forces[i].F_y;
    force_x += f_x;
    force_y += f_y;
    moment += hubs_[i].x() * f_y - hubs_[i].y() * f_x;
  }
  const double cos_psi = std::cos(z[control::kPsi]);
  const double sin_psi = std::sin(z[control::kPsi]);
  State derivative;
  derivative[control::kX] = z[control::kUpsilon] * cos_psi - z[control::kNu] * sin_psi;
  derivative[control::kY] = z[control::kUpsilon] * sin_psi + z[control::kNu] * cos_psi;
  derivative[control::kUpsilon] = z[control::kOmega] * z[control::kNu] + force_x / v.m;
  derivative[control::kNu] = -z[control::kOmega] * z[control::kUpsilon] + force_y / v.m;
  derivative[control::kPsi] = z[control::kOmega];
  derivative[control::kOmega] = moment / v.I_z;
  const Eigen::Vector2d pull = Pull();
  derivative[control::kUpsilon] += pull.x();
  derivative[control::kNu] += pull.y();
  return derivative;
}

// On a slope: the brake demands more than gravity pulls along the road, and the tyres can give it.
bool Plant::BrakeHolds(const Input& u) const {
  const double pull = std::abs(Pull().x());
  const bool slides = parameters_.tyre == Tyre::kSaturating && pull > parameters_.mu * kGravity;
  return pull > 0.0 && pull < -u[control::kAcceleration] && !slides;
}

void Plant::Step(const Input& start, const Input& middle, const Input& end, double h) {
  const bool holds = BrakeHolds(start) && BrakeHolds(end);
  const bool stands = state_[control::kUpsilon] == 0.0;
  if (!holds || !stands) {
    const State k1 = Derivative(state_, start);
    const State k2 = Derivative(state_ + 0.5 * h * k1, middle);
    const State k3 = Derivative(state_ + 0.5 * h * k2, middle);
    const State k4 = Derivative(state_ + h * k3, end);
    state_ += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  // The fading brake would let the vehicle creep down the slope at this speed.
  const double creep = kBrakeFade * std::abs(Pull().x()) / std::max(-end[control::kAcceleration], 1e-9);
  if (holds && std::abs(state_[control::kUpsilon]) <= 1.1 * creep) {
    state_[control::kUpsilon] = state_[control::kNu] = state_[control::kOmega] = 0.0;
  }
  time_ += h;
}

}  // namespace sim
