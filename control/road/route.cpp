#include "control/road/route.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <variant>

#include "control/road/curve.hpp"
#include "control/road/projection.hpp"

namespace control {
namespace {

using detail::Cubic;
using detail::LinearCurvature;
using Eigen::Vector2d;

struct Segment {
  double s = 0.0;  // arc length at its start [m]
  double length = 0.0;
  RoutePoint start;
  std::variant<LinearCurvature, Cubic> shape;

  RoutePoint At(double ds) const {
    return std::visit([&](const auto& curve) { return curve.At(start, ds); }, shape);
  }
};

// Target speed v = v_from + slope s', s' from 0 to length: s'(t) = v_from (e^{slope t} - 1) / slope.
struct SpeedRamp {
  double s;  // arc length at its start [m]
  double t;
  double length;
  double from;
  double to;

  double Slope() const { return (to - from) / length; }
  double Duration() const {
    const double ratio = (to - from) / from;
    return length / from * (std::abs(ratio) < 1e-12 ? 1.0 : std::log1p(ratio) / ratio);
  }
  double DistanceAfter(double time) const {
    const double x = Slope() * time;
    return from * time * (std::abs(x) < 1e-12 ? 1.0 : std::expm1(x) / x);
  }
};

// Last element whose `value` is not above x; the first one if there is none.
template <typename T>
const T& LastNotAbove(const std::vector<T>& list, double T::*value, double x) {
  const auto next = std::ranges::upper_bound(list, x, {}, value);
  return next == list.begin() ? list.front() : *(next - 1);
}

void Require(bool holds, const std::string& text) {
  if (!holds) throw std::invalid_argument(text);
}

constexpr double kSampleSpacing = 1.0;  // step of the coarse search for the nearest point [m]
constexpr double kHintWindow = 25.0;    // [m]

}  // namespace

struct Route::Geometry {
  std::vector<Segment> segments;
  std::vector<SpeedRamp> ramps;
  std::vector<double> knots{0.0};  // arc lengths of the waypoints or the ends of the pieces
  std::vector<Vector2d> samples;   // spaced evenly from start to end
  double spacing = 0.0;
  double length = 0.0;
  RoutePoint end;

  void Append(double segment_length, const RoutePoint& start,
              const std::variant<LinearCurvature, Cubic>& shape) {
    segments.push_back({length, segment_length, start, shape});
    length += segment_length;
    end = segments.back().At(segment_length);
  }
  void AppendRamp(double ramp_length, double from, double to) {
    const double t = ramps.empty() ? 0.0 : ramps.back().t + ramps.back().Duration();
    const double s = ramps.empty() ? 0.0 : ramps.back().s + ramps.back().length;
    ramps.push_back({s, t, ramp_length, from, to});
  }
  void Sample() {
    const int intervals = std::max(1, static_cast<int>(std::ceil(length / kSampleSpacing)));
    spacing = length / intervals;
    for (int i = 0; i <= intervals; ++i) {
      const RoutePoint point = At(i * spacing);
      samples.emplace_back(point.X, point.Y);
    }
  }
  RoutePoint At(double s) const {
    RoutePoint point;
    const double inside = std::clamp(s, 0.0, length);
    if (inside == length) {
      point = end;
    } else {
      const Segment& segment = LastNotAbove(segments, &Segment::s, inside);
      point = segment.At(std::min(inside - segment.s, segment.length));
    }
    if (s != inside) point = StraightAhead(point, s - inside);
    const SpeedRamp& ramp = LastNotAbove(ramps, &SpeedRamp::s, inside);
    point.speed = ramp.from + ramp.Slope() * std::min(inside - ramp.s, ramp.length);
    return point;
  }
};

Route::Route(std::shared_ptr<const Geometry> geometry) : geometry_(std::move(geometry)) {}

Route Route::FromPieces(const RouteStart& start, double speed, std::span<const RoutePiece> pieces) {
  Require(!pieces.empty(), "no pieces");
  Require(std::isfinite(speed) && speed > 0.0, "speed must be above 0");
  Require(std::isfinite(start.X) && std::isfinite(start.Y) && std::isfinite(start.psi),
          "start is not finite");
  auto geometry = std::make_shared<Geometry>();
  geometry->end = {start.X, start.Y, start.psi, 0.0, 0.0};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const RoutePiece& piece = pieces[i];
    const double speed_to = piece.speed.value_or(speed);
    const std::string name = "piece " + std::to_string(i) + ": ";
    Require(std::isfinite(piece.length) && piece.length > 0.0, name + "length must be above 0");
    Require(std::isfinite(piece.curvature_from) && std::isfinite(piece.curvature_to),
            name + "curvature is not finite");
    Require(std::isfinite(speed_to) && speed_to > 0.0, name + "speed must be above 0");
    const double turn = piece.length * std::max(std::abs(piece.curvature_from), std::abs(piece.curvature_to));
    Require(turn < 1e4, name + "turns too often");
    const double slope = (piece.curvature_to - piece.curvature_from) / piece.length;
    const int parts = std::max(1, static_cast<int>(std::ceil(turn / detail::kLargestTurn)));
    for (int part = 0; part < parts; ++part) {
      const double curvature = piece.curvature_from + slope * (piece.length * part / parts);
      geometry->Append(piece.length / parts, geometry->end, LinearCurvature{curvature, slope});
    }
    geometry->AppendRamp(piece.length, speed, speed_to);
    geometry->knots.push_back(geometry->length);
    speed = speed_to;
  }
  geometry->Sample();
  return Route(std::move(geometry));
}

std::shared_ptr<Route::Geometry> Route::Spline(std::span<const Vector2d> waypoints) {
  Require(waypoints.size() >= 2, "fewer than two waypoints");
  Require(waypoints[0].allFinite(), "waypoint 0 is not finite");
  std::vector<double> h;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    h.push_back((waypoints[i] - waypoints[i - 1]).norm());
    Require(std::isfinite(h.back()), "waypoint " + std::to_string(i) + " is not finite");
    Require(h.back() > 0.0, "waypoint " + std::to_string(i) + " repeats its predecessor");
  }
  const std::vector<Vector2d> second = detail::SplineCurvature(waypoints, h);
  auto geometry = std::make_shared<Geometry>();
  for (std::size_t i = 0; i < h.size(); ++i) {
    Cubic cubic{{waypoints[i],
                 (waypoints[i + 1] - waypoints[i]) / h[i] - h[i] / 6.0 * (2.0 * second[i] + second[i + 1]),
                 0.5 * second[i], (second[i + 1] - second[i]) / (6.0 * h[i])},
                h[i],
                0.0};
    cubic.length = cubic.ArcLength(h[i]);
    RoutePoint start = geometry->end;
    if (i == 0) start.psi = std::atan2(cubic.c[1].y(), cubic.c[1].x());
    geometry->Append(cubic.length, start, cubic);
    geometry->knots.push_back(geometry->length);
  }
  return geometry;
}

Route Route::ThroughWaypoints(std::span<const Vector2d> waypoints, double speed) {
  Require(std::isfinite(speed) && speed > 0.0, "speed must be above 0");
  std::shared_ptr<Geometry> geometry = Spline(waypoints);
  geometry->AppendRamp(geometry->length, speed, speed);
  geometry->Sample();
  return Route(std::move(geometry));
}

Route Route::ThroughWaypoints(std::span<const Vector2d> waypoints, std::span<const double> speeds) {
  Require(speeds.size() == waypoints.size(), "there must be one speed for each waypoint");
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    Require(std::isfinite(speeds[i]) && speeds[i] > 0.0,
            "waypoint " + std::to_string(i) + ": speed must be above 0");
  }
  std::shared_ptr<Geometry> geometry = Spline(waypoints);
  for (std::size_t i = 0; i + 1 < speeds.size(); ++i) {
    geometry->AppendRamp(geometry->segments[i].length, speeds[i], speeds[i + 1]);
  }
  geometry->Sample();
  return Route(std::move(geometry));
}

std::span<const double> Route::knots() const {
  return geometry_->knots;
}

double Route::length() const {
  return geometry_->length;
}

double Route::duration() const {
  return geometry_->ramps.back().t + geometry_->ramps.back().Duration();
}

RoutePoint Route::At(double s) const {
  return geometry_->At(s);
}

double Route::ArcLengthAt(double t) const {
  const SpeedRamp& first = geometry_->ramps.front();
  if (t <= 0.0) return first.from * t;
  const double over = t - duration();
  if (over >= 0.0) return length() + over * geometry_->ramps.back().to;
  const SpeedRamp& ramp = LastNotAbove(geometry_->ramps, &SpeedRamp::t, t);
  return ramp.s + ramp.DistanceAfter(t - ramp.t);
}

RouteProjection Route::Project(const Vector2d& position, std::optional<double> hint) const {
  const std::vector<Vector2d>& samples = geometry_->samples;
  const double spacing = geometry_->spacing;
  const int last = static_cast<int>(samples.size()) - 1;
  const auto index = [&](double s) {
    return static_cast<int>(std::clamp(s / spacing, 0.0, static_cast<double>(last)));
  };
  const int from = hint ? index(*hint - kHintWindow) : 0;
  const int to = hint ? index(*hint + kHintWindow) : last;
  const auto distance = [&](int k) {
    return (samples[static_cast<std::size_t>(k)] - position).squaredNorm();
  };
  const int i = NearestOfAll(distance, from, to);

  // The distance along the tangent falls through zero at the nearest point: Newton's method, kept in a
  // bracket.
  constexpr double kFar = 1e6;
  double low = i == 0 ? -kFar : (i - 1) * spacing;
  double high = i == last ? length() + kFar : (i + 1) * spacing;
  RouteProjection result{i * spacing, 0.0};
  for (int iteration = 0; iteration < 100; ++iteration) {
    const RoutePoint point = At(result.s);
    const auto [ahead, left] = OffsetFrom(Position(point), point.psi, position);
    result.lateral = left;
    if (std::abs(ahead) < 1e-10) break;
    (ahead > 0.0 ? low : high) = result.s;
    const double newton = result.s + ahead / std::max(0.1, 1.0 - point.curvature * result.lateral);
    result.s = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return result;
}

std::vector<Vector2d> SampleRoute(const Route& route, double t_s) {
  Require(std::isfinite(t_s) && t_s > 0.0, "t_s must be above 0");
  const auto steps = static_cast<std::size_t>(std::floor(route.duration() / t_s * (1.0 + 1e-12)));
  std::vector<Vector2d> points;
  points.reserve(steps + 1);
  for (std::size_t k = 0; k <= steps; ++k) {
    const RoutePoint point = route.At(route.ArcLengthAt(static_cast<double>(k) * t_s));
    points.emplace_back(point.X, point.Y);
  }
  return points;
}

}  // namespace control
