// A road's reference path in the plane with a target speed, by arc length s [m], and the time-indexed points
// (X, Y) that the controller is given (paper, Section NMPC: "only the (X_ref, Y_ref) values of the reference
// are available").
//
// A path is either a chain of pieces whose curvature is linear in s (straight, arc, clothoid; positive curvature
// turns left), integrated to round-off, or a natural cubic spline over chord length through waypoints. A route
// continues straight before its start and after its end.
//
// Example:
//   const auto route = control::Route::FromPieces({.X = 0, .Y = 0, .psi = 0}, 12.0, pieces);
//   const control::RoutePoint point = route.At(35.0);
//   const control::RouteProjection place = route.Project({X, Y}, place_before.s);
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "control/vehicle/types.hpp"

namespace control {

struct RouteStart {
  double X = 0.0;    // [m]
  double Y = 0.0;    // [m]
  double psi = 0.0;  // heading [rad]
};

struct RoutePiece {
  double length = 0.0;               // > 0 [m]
  double curvature_from = 0.0;       // [1/m]
  double curvature_to = 0.0;         // [1/m]
  std::optional<double> speed = {};  // target speed at its end, > 0 [m/s]; if empty, that of its start
};

struct RoutePoint {
  double X = 0.0;
  double Y = 0.0;
  double psi = 0.0;        // continuous along the route, not wrapped [rad]
  double curvature = 0.0;  // [1/m]
  double speed = 0.0;      // target speed [m/s]
};

struct RouteProjection {
  double s = 0.0;  // arc length of the nearest point [m]; below 0 or past length() on the straight extensions
  double lateral = 0.0;  // signed distance to it, left positive [m]
};

class Route {
 public:
  // The target speed is `speed` at the start and changes linearly over s to that of each piece. Throws
  // std::invalid_argument, which names the piece, if there are no pieces or a value is not finite or not in the range
  // above.
  [[nodiscard]] static Route FromPieces(const RouteStart& start, double speed,
                                        std::span<const RoutePiece> pieces);
  // Throws std::invalid_argument, which names the waypoint, if there are fewer than two, two consecutive ones are
  // equal or a value is not finite, and also if speed <= 0.
  [[nodiscard]] static Route ThroughWaypoints(std::span<const Eigen::Vector2d> waypoints, double speed);
  // The target speed is that of each waypoint and changes linearly over s between them. Throws as above, and also if there
  // is not one speed for each waypoint.
  [[nodiscard]] static Route ThroughWaypoints(std::span<const Eigen::Vector2d> waypoints,
                                              std::span<const double> speeds);

  [[nodiscard]] double length() const;    // [m]
  [[nodiscard]] double duration() const;  // at the target speed [s]

  // Arc lengths of the waypoints, or of the start and each piece's end [m].
  [[nodiscard]] std::span<const double> knots() const;

  [[nodiscard]] RoutePoint At(double s) const;
  // Arc length at time t of a vehicle that starts at s = 0 at t = 0 and keeps the target speed.
  [[nodiscard]] double ArcLengthAt(double t) const;

  // The point of the route nearest to `position`: within 25 m of arc length of `hint` if that is given, on the whole
  // route otherwise.
  [[nodiscard]] RouteProjection Project(const Eigen::Vector2d& position,
                                        std::optional<double> hint = {}) const;

 private:
  struct Geometry;
  [[nodiscard]] static std::shared_ptr<Geometry> Spline(std::span<const Eigen::Vector2d> waypoints);
  explicit Route(std::shared_ptr<const Geometry> geometry);
  std::shared_ptr<const Geometry> geometry_;  // immutable
};

// Points that a vehicle on the route at the target speed reaches at 0, t_s, 2 t_s, ... up to the end of the
// route.
[[nodiscard]] std::vector<Eigen::Vector2d> SampleRoute(const Route& route, double t_s);

}  // namespace control
