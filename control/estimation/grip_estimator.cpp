#include "control/estimation/grip_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace control {
namespace {

constexpr double kNotFelt = std::numeric_limits<double>::infinity();
constexpr double kSmoothing = 0.15;   // time constant of the filters [s]
constexpr double kRise = 0.02;        // rate at which the bound rises [1/s]
constexpr double kForget = 0.3;       // rate at which what the tyres gave is forgotten [1/s]
constexpr int kLasting = 3;           // measurements in succession that must show a shortfall
constexpr double kClearlyLess = 0.8;  // share of the bound below which a felt coefficient lowers it
// Lateral: an axle is near sliding if it gives less than this share of the linear force. A tyre of the brush model
// then gives 95 % of its greatest force.
constexpr double kLateralShare = 0.5;
constexpr double kLeastShortfall =
    40.0;                          // of an axle, times υ: above what noise of ν makes of the slip [m²/s³]
constexpr double kFalling = 0.95;  // an axle whose demand is below this share of the last one is unloaded
constexpr double kLateralSpeed = 6.0;  // [m/s]
constexpr double kMostBraking = 2.0;   // above it, the shift of load between the axles is too large [m/s²]
// Longitudinal.
constexpr double kBrakingShare = 0.75;
constexpr double kLeastBraking = 2.5;  // [m/s²]
constexpr double kBrakingSpeed = 2.0;  // [m/s]

// The coefficient of an axle that gives `response` where linear tyres would give `demand`, both above 0 [m/s²]. Brush
// model: response/demand = 1 − x + x²/3 with x = demand/(3 μ g), and response = μ g where x ≥ 1.
double BrushFriction(double demand, double response) {
  const double share = response / demand;
  if (share <= 1.0 / 3.0) return response / kGravity;
  const double x = 1.5 * (1.0 - std::sqrt(std::max(1.0 - 4.0 / 3.0 * (1.0 - share), 0.0)));
  return demand / (3.0 * x * kGravity);
}

}  // namespace

void GripEstimator::Restart() {
  demand_ = before_ = response_ = Axles::Zero();
  braking_ = slowing_ = given_ = 0.0;
  lasting_ = 0;
}

void GripEstimator::Reset() {
  Restart();
  limit_ = mu_;
}

void GripEstimator::Update(const State& before, const State& after, const Input& u,
                           const Disturbance& disturbance, double dt) {
  const State mean = 0.5 * (before + after);
  const State rate = (after - before) / dt;
  before_ = demand_;
  const double share = dt / (dt + kSmoothing);
  const auto smooth = [share](auto& value, const auto& now) { value += share * (now - value); };
  speed_ = mean[kUpsilon];
  demanded_ = std::max(-u[kAcceleration], 0.0);
  smooth(braking_, -u[kAcceleration]);
  smooth(slowing_, -(rate[kUpsilon] - mean[kOmega] * mean[kNu] - disturbance.a_x));
  if (speed_ > kLateralSpeed) {
    const double lateral = rate[kNu] + mean[kUpsilon] * mean[kOmega] - disturbance.a_y;
    const double turning = vehicle_.I_z * rate[kOmega] / vehicle_.m;
    Disturbance careful = disturbance;  // a stiffness above the model's would only raise the demand
    careful.stiffness_factor = std::min(careful.stiffness_factor, 1.0);
    smooth(demand_, LinearDemand(vehicle_, mean, u, careful));
    smooth(response_, Axles(lateral + turning / vehicle_.l_r, lateral - turning / vehicle_.l_f));
  }
  limit_ = std::min(limit_ + kRise * dt, mu_);
  const double felt = std::min(FeltLaterally(), FeltWhenBraking());
  lasting_ = felt < kClearlyLess * limit_ ? lasting_ + 1 : 0;
  given_ = std::max(given_ - kForget * dt, Given());
  if (lasting_ >= kLasting) limit_ = felt;
  limit_ = std::max(limit_, std::min(given_, mu_));
}

// The coefficient that the tyres use now.
double GripEstimator::Given() const {
  const double across = std::abs(braking_) > kMostBraking ? 0.0 : response_.cwiseAbs().maxCoeff();
  return std::max(across, std::min(slowing_, braking_)) / kGravity;
}

double GripEstimator::FeltLaterally() const {
  if (speed_ <= kLateralSpeed || std::abs(braking_) > kMostBraking) return kNotFelt;
  double felt = kNotFelt;
  for (const Axle axle : {kFront, kRear}) {
    const double demand = std::abs(demand_[axle]);
    const double response = std::max(std::copysign(1.0, demand_[axle]) * response_[axle], 0.0);
    // The input is known less well in time than the force, so a falling demand seems larger than it is.
    if ((demand - response) * speed_ < kLeastShortfall || demand < kFalling * std::abs(before_[axle]))
      continue;
    if (response > kLateralShare * demand) continue;
    felt = std::min(felt, std::hypot(BrushFriction(demand, response), Along(axle) / kGravity));
  }
  return felt;
}

// The longitudinal force of the axle's tyres [m/s²]: all brake, but only those of the driven axle drive.
double GripEstimator::Along(Axle axle) const {
  if (braking_ >= 0.0) return braking_;
  const bool drives =
      vehicle_.driven == DrivenAxle::kBoth || (vehicle_.driven == DrivenAxle::kFront) == (axle == kFront);
  return drives ? TyreDemand(vehicle_, -braking_) : 0.0;
}

double GripEstimator::FeltWhenBraking() const {
  if (speed_ < kBrakingSpeed || std::min(braking_, demanded_) < kLeastBraking ||
      slowing_ > kBrakingShare * braking_)
    return kNotFelt;
  const double across = response_.cwiseAbs().minCoeff();
  // The demand is known exactly, so their ratio tells the force before the filter has settled.
  const double along = std::max(slowing_, 0.0) / braking_ * demanded_;
  return std::hypot(along, across) / kGravity;
}

}  // namespace control
