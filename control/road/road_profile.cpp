#include "control/road/road_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/road/projection.hpp"

namespace control {
namespace {

constexpr double kShareOfGrip = 0.9;  // that is used

double Mix(double from, double to, double share) {
  return from + share * (to - from);
}

}  // namespace

double StoppingSpeed(double distance, double deceleration) {
  return distance > RoadProfile::kStopWithin ? std::sqrt(2.0 * deceleration * distance) : 0.0;
}

double ShareWithin(const SpeedLimits& limits, double grip) {
  return std::min(kShareOfGrip * grip / std::hypot(limits.lateral, limits.deceleration), 1.0);
}

SpeedLimits WithinGrip(const SpeedLimits& limits, double grip) {
  const double share = ShareWithin(limits, grip);
  return {.lateral = share * limits.lateral,
          .acceleration = share * limits.acceleration,
          .deceleration = share * limits.deceleration,
          .emergency = std::min(limits.emergency, kShareOfGrip * grip)};
}

RoadProfile::RoadProfile(const Route& route, const RoadEdges& edges, const SpeedLimits& limits)
    : length_(route.length()), edges_(edges), limits_(limits) {
  const auto steps = std::max<long>(1, std::lround(std::ceil(length_ / kSpacing)));
  spacing_ = length_ / static_cast<double>(steps);
  points_.reserve(static_cast<std::size_t>(steps) + 1);
  along_.reserve(static_cast<std::size_t>(steps) + 1);
  bend_squared_.reserve(static_cast<std::size_t>(steps) + 1);
  for (long k = 0; k <= steps; ++k) {
    RoutePoint point = route.At(static_cast<double>(k) * spacing_);
    const double curvature = std::max(std::abs(point.curvature), 1e-9);
    bend_squared_.push_back(limits.lateral / curvature);
    point.speed = std::min(point.speed, std::sqrt(bend_squared_.back()));
    points_.push_back(point);
    along_.push_back(Along(point.psi));
  }
  points_.back().speed = bend_squared_.back() = 0.0;
  for (std::size_t k = points_.size() - 1; k-- > 0;) {
    const double next = points_[k + 1].speed;
    points_[k].speed =
        std::min(points_[k].speed, std::sqrt(next * next + 2.0 * limits.deceleration * spacing_));
    bend_squared_[k] =
        std::min(bend_squared_[k], bend_squared_[k + 1] + 2.0 * limits.deceleration * spacing_);
  }
}

RoadProfile::Place RoadProfile::PlaceAt(double s) const {
  const double place = s / spacing_;
  const auto k = std::min(static_cast<std::size_t>(place), points_.size() - 2);
  return {.k = k, .share = place - static_cast<double>(k)};
}

RoutePoint RoadProfile::At(double s) const {
  if (s <= 0.0) {
    return StraightAhead(points_.front(), s);
  }
  if (s >= length_) {
    return StraightAhead(points_.back(), s - length_);
  }
  const auto [k, share] = PlaceAt(s);
  const RoutePoint& from = points_[k];
  const RoutePoint& to = points_[k + 1];
  // v² is linear in s, so that the speed falls at the profile's deceleration down to 0.
  const double squared = Mix(from.speed * from.speed, to.speed * to.speed, share);
  return {.X = Mix(from.X, to.X, share),
          .Y = Mix(from.Y, to.Y, share),
          .psi = Mix(from.psi, to.psi, share),
          .curvature = Mix(from.curvature, to.curvature, share),
          .speed = std::sqrt(squared)};
}

double RoadProfile::SpeedWithin(double grip, double s) const {
  const double speed = At(s).speed, share = ShareWithin(limits_, grip);
  if (share >= 1.0 || s >= length_) return speed;
  const auto [k, from] = PlaceAt(std::max(s, 0.0));
  return std::min(speed, std::sqrt(share * Mix(bend_squared_[k], bend_squared_[k + 1], from)));
}

double RoadProfile::TurnWithin(double s, double distance) const {
  const double last = static_cast<double>(points_.size() - 1);
  const auto sample = [&](double place) { return static_cast<std::size_t>(std::clamp(place, 0.0, last)); };
  const std::size_t end = sample(std::ceil((s + distance) / spacing_));
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t k = sample(std::floor((s - distance) / spacing_)); k <= end; ++k) {
    least = std::min(least, points_[k].psi);
    most = std::max(most, points_[k].psi);
  }
  return most - least;
}

RouteProjection RoadProfile::Project(const Eigen::Vector2d& position, double hint) const {
  const auto at = [&](int k) -> const RoutePoint& { return points_[static_cast<std::size_t>(k)]; };
  const auto distance = [&](int k) { return (position - Position(at(k))).squaredNorm(); };
  const int last = static_cast<int>(points_.size()) - 1;
  const auto from = static_cast<int>(std::clamp(std::round(hint / spacing_), 0.0, static_cast<double>(last)));
  const int k = NearestSample(distance, from, 0, last);
  const RoutePoint& point = at(k);
  const auto [ahead, left] = OffsetFrom(Position(point), along_[static_cast<std::size_t>(k)], position);
  // On a curve, the arc length from the sample to the projection differs from the distance ahead along the tangent.
  const bool inside = k > 0 && k < last;
  const double stretch = inside ? std::max(1.0 - point.curvature * left, 0.1) : 1.0;
  const double s = static_cast<double>(k) * spacing_ + ahead / stretch;
  return {.s = s, .lateral = LateralOf(position, s)};
}

// Distance of the position to the left of the road's point at s. The direction there is found without its angle, whose sine
// and cosine would take most of the time.
double RoadProfile::LateralOf(const Eigen::Vector2d& position, double s) const {
  if (s <= 0.0) return OffsetFrom(Position(points_.front()), along_.front(), position).left;
  if (s >= length_) return OffsetFrom(Position(points_.back()), along_.back(), position).left;
  const auto [k, share] = PlaceAt(s);
  const Eigen::Vector2d from = Position(points_[k]), along = along_[k];
  return OffsetFrom(from + share * (Position(points_[k + 1]) - from),
                    (along + share * (along_[k + 1] - along)).normalized(), position)
      .left;
}

}  // namespace control
