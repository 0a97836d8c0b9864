// The road as the control path needs it: the route sampled at equal steps of arc length s [m], with the speed that
// friction, comfort and the end of the route allow. Look-ups take constant time and do not allocate.
//
//   v(s) ≤ target speed,   v² |κ| ≤ lateral limit,   d(v²)/ds ≥ −2 deceleration,   v(length) = 0
#pragma once

#include <optional>
#include <vector>

#include "control/road/road_edges.hpp"
#include "control/road/route.hpp"

namespace control {

struct SpeedLimits {
  double lateral = 3.0;       // in curves [m/s²], > 0
  double acceleration = 1.5;  // [m/s²], > 0
  double deceleration = 2.0;  // [m/s²], > 0
  double emergency = 5.0;     // deceleration before an obstacle that cannot be passed [m/s²], > 0
};

// The share of the comfortable accelerations that tyres with this grip [m/s²] can give, in a bend and braking at once.
[[nodiscard]] double ShareWithin(const SpeedLimits& limits, double grip);

// The limits where the tyres have this grip [m/s²].
[[nodiscard]] SpeedLimits WithinGrip(const SpeedLimits& limits, double grip);

class RoadProfile {
 public:
  static constexpr double kSpacing = 0.5;      // sample spacing [m]
  static constexpr double kStopWithin = 0.25;  // nearer than this to a stopping point, the speed is 0 [m]

  RoadProfile(const Route& route, const RoadEdges& edges, const SpeedLimits& limits);

  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] const RoadEdges& edges() const { return edges_; }
  [[nodiscard]] const SpeedLimits& limits() const { return limits_; }

  // `speed` is the profile's. The road continues straight before the start and after the end, where the speed is 0.
  [[nodiscard]] RoutePoint At(double s) const;
  // The profile's speed where the tyres have this grip [m/s²]. Where the target speed falls, the comfortable deceleration
  // counts even if they cannot give it.
  [[nodiscard]] double SpeedWithin(double grip, double s) const;
  // The road's edges beside the point at s.
  [[nodiscard]] RoadBounds RoadAt(double s) const { return edges_.At(s); }
  // The road's bounds where they are narrowest between two arc lengths, from ≤ to.
  [[nodiscard]] RoadBounds NarrowestRoad(double from, double to) const { return edges_.Narrowest(from, to); }
  // The largest angle between directions of the road within `distance` [m] before and behind s [rad].
  [[nodiscard]] double TurnWithin(double s, double distance) const;
  // The nearest point of the road profile, by local search from s = `hint`.
  [[nodiscard]] RouteProjection Project(const Eigen::Vector2d& position, double hint) const;

 private:
  // A place between samples k and k + 1.
  struct Place {
    std::size_t k = 0;
    double share = 0.0;  // of the spacing, from sample k on
  };
  [[nodiscard]] Place PlaceAt(double s) const;
  [[nodiscard]] double LateralOf(const Eigen::Vector2d& position, double s) const;

  std::vector<RoutePoint> points_;      // points at s = k spacing_
  std::vector<Eigen::Vector2d> along_;  // unit vectors along the road there
  std::vector<double> bend_squared_;    // v² that bends and the end of the route allow there [m²/s²]
  double spacing_;
  double length_;
  RoadEdges edges_;
  SpeedLimits limits_;
};

// Highest speed from which a vehicle stops within `distance` [m] at `deceleration` [m/s²]; 0 if `distance` is within
// kStopWithin.
[[nodiscard]] double StoppingSpeed(double distance, double deceleration);

}  // namespace control
