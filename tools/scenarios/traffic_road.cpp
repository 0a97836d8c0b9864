#include "tools/scenarios/traffic_road.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>
#include <vector>

#include "sim/scenario.hpp"

namespace tools {
namespace {

constexpr double kShortest = 10.0, kLongest = 18.0;  // duration of a drive at the target speed [s]
constexpr double kReach = 600.0;                     // longest road: it does not leave the map [m]
constexpr double kLateralShare = 0.8;                // share of μ g that bends need at most
constexpr double kSlowingShare = 0.35;               // share of μ g with which the target speed falls
constexpr double kSharpestGentle = 1.0 / 15.0;       // curvature of a gentle bend [1/m]
constexpr double kTightest = 12.0, kWidest = 45.0;   // radii of sharp bends [m]
constexpr double kShortestRamp = 8.0;                // clothoid before and after a bend [m]
constexpr double kLastStraight = 10.0;               // [m]
constexpr double kHalfLane = 1.05;  // least distance from the path to an edge, on the straight [m]
constexpr double kOverhang = 4.0;   // what the vehicle's ends need in a bend: this times the curvature [m²]
constexpr double kEdgeSpacing = 4.0;  // of the edges' samples [m]

struct Bend {
  double sign;
  bool sharp;
  double sharpness;  // share of the lateral acceleration allowed
  double radius;     // of a sharp bend [m]
  double turn;       // [rad]
  double before;     // straight before it, in time at the target speed [s]
};

Bend DrawBend(PointReader& reader) {
  return {.sign = reader.Sign(),
          .sharp = reader.Chance(0.35),
          .sharpness = reader.Uniform(0.15, 1.0),
          .radius = reader.Uniform(kTightest, kWidest),
          .turn = reader.Uniform(0.15, 1.0) * std::numbers::pi,
          .before = reader.Uniform(0.2, 3.0)};
}

class RoadBuilder {
 public:
  RoadBuilder(double speed, double mu, double length) : speed_(speed), mu_(mu), left_(length) {
    Add({.length = speed});
  }

  // Adds nothing if what is left is too short for the bend.
  void AddBend(const Bend& bend) {
    const double grip = bend.sharpness * kLateralShare * mu_ * sim::kGravity;
    const double curvature =
        bend.sharp ? 1.0 / bend.radius : std::min(kSharpestGentle, grip / (speed_ * speed_));
    const double speed = bend.sharp ? std::min(speed_, std::sqrt(grip * bend.radius)) : speed_;
    const double slowing = speed_ * (speed_ - speed) / (kSlowingShare * mu_ * sim::kGravity);
    const double ramp = std::min(std::max(kShortestRamp, 0.8 * speed), 0.8 * bend.turn / curvature);
    const double before = bend.before * speed_;
    const double room = left_ - kLastStraight - before - 2.0 * slowing - 2.0 * ramp;
    const double arc = std::min(bend.turn / curvature - ramp, room);
    if (arc < 1.0) return;
    const double turn = curvature * (arc + ramp);
    const double sign = std::abs(heading_ + bend.sign * turn) > std::numbers::pi ? -bend.sign : bend.sign;
    heading_ += sign * turn;
    Add({.length = before});
    if (slowing > 0.0) Add({.length = slowing, .speed = speed});
    Add({.length = ramp, .curvature_to = sign * curvature});
    Add({.length = arc, .curvature_from = sign * curvature, .curvature_to = sign * curvature});
    Add({.length = ramp, .curvature_from = sign * curvature});
    if (slowing > 0.0) Add({.length = slowing, .speed = speed_});
    ++bends_;
  }

  [[nodiscard]] int bends() const { return bends_; }
  [[nodiscard]] control::Route Finish(double heading) {
    Add({.length = left_});
    const control::RouteStart start{.X = 0.5 * (sim::kMapMinX + sim::kMapMaxX),
                                    .Y = 0.5 * (sim::kMapMinY + sim::kMapMaxY),
                                    .psi = heading};
    return control::Route::FromPieces(start, speed_, pieces_);
  }

 private:
  void Add(const control::RoutePiece& piece) {
    pieces_.push_back(piece);
    left_ -= piece.length;
  }

  double speed_;
  double mu_;
  double left_;  // length that is not yet built [m]
  double heading_ = 0.0;
  int bends_ = 0;
  std::vector<control::RoutePiece> pieces_;
};

enum class RoadLayout { kTwoLanes, kWide, kNarrow };

struct Layout {
  RoadLayout layout;
  control::RoadBounds bounds;
};

Layout DrawLayout(PointReader& reader) {
  const double which = reader.Uniform(0.0, 1.0), right = reader.Uniform(0.0, 1.0),
               left = reader.Uniform(0.0, 1.0);
  if (which < 0.45) {
    return {.layout = RoadLayout::kTwoLanes,
            .bounds = {.left = std::lerp(4.6, 6.2, left), .right = -std::lerp(1.6, 2.3, right)}};
  }
  if (which < 0.75) {
    return {.layout = RoadLayout::kWide,
            .bounds = {.left = std::lerp(3.0, 4.5, left), .right = -std::lerp(3.0, 4.5, right)}};
  }
  return {.layout = RoadLayout::kNarrow,
          .bounds = {.left = std::lerp(1.2, 2.4, left), .right = -std::lerp(1.2, 2.4, right)}};
}

// A stretch on which the distances to the edges are multiplied by a factor.
struct Stretch {
  double middle = 0.0;  // [m]
  double half = 0.0;    // [m]
  double taper = 1.0;   // at either end [m]
  double factor = 1.0;

  [[nodiscard]] double FactorAt(double s) const {
    const double beyond = std::abs(s - middle) - half;
    return std::lerp(factor, 1.0, std::clamp(beyond / taper, 0.0, 1.0));
  }
};

Stretch DrawStretch(PointReader& reader, double length) {
  const bool present = reader.Chance(0.5);
  const Stretch stretch{.middle = reader.Uniform(0.2, 0.9) * length,
                        .half = reader.Uniform(5.0, 40.0),
                        .taper = reader.Uniform(10.0, 40.0),
                        .factor = reader.Uniform(0.4, 1.5)};
  return present ? stretch : Stretch{};
}

control::RoadEdges EdgesOf(const control::Route& route, const control::RoadBounds& bounds,
                           const Stretch& stretch) {
  const auto curvature = [&](double s) {
    double greatest = 0.0;
    for (const double off : {-8.0, -4.0, 0.0, 4.0, 8.0})
      greatest = std::max(greatest, std::abs(route.At(s + off).curvature));
    return greatest;
  };
  std::vector<control::RoadSample> samples;
  for (double s = 0.0; s <= route.length(); s += kEdgeSpacing) {
    const double factor = stretch.FactorAt(s), least = kHalfLane + kOverhang * curvature(s);
    samples.push_back({.s = s,
                       .bounds = {.left = std::max(factor * bounds.left, least),
                                  .right = std::min(factor * bounds.right, -least)}});
  }
  return control::RoadEdges(samples);
}

std::string Describe(const TrafficRoad& road, RoadLayout layout, double speed, int bends) {
  double narrowest = 1e9, slowest = speed;
  for (double s = 0.0; s <= road.route.length(); s += kEdgeSpacing) {
    const control::RoadBounds bounds = road.edges.At(s);
    narrowest = std::min(narrowest, bounds.left - bounds.right);
    slowest = std::min(slowest, road.route.At(s).speed);
  }
  const char* const name = layout == RoadLayout::kTwoLanes ? "two lanes"
                           : layout == RoadLayout::kWide   ? "wide lane"
                                                           : "narrow street";
  std::string text = fmt::format("{}, {:.1f} m/s", name, speed);
  if (slowest < speed - 0.1) text += fmt::format(" down to {:.1f}", slowest);
  text += fmt::format(", {} bend{}", bends, bends == 1 ? "" : "s");
  return text + fmt::format(", {:.1f} m at its narrowest", narrowest);
}

}  // namespace

TrafficRoad DrawTrafficRoad(PointReader reader, const Interval& speeds, double mu) {
  const double speed = reader.Uniform(speeds.low, speeds.high);
  const double length = std::min(reader.Uniform(kShortest, kLongest) * speed, kReach);
  const double heading = reader.Uniform(-std::numbers::pi, std::numbers::pi);
  const Layout layout = DrawLayout(reader);
  RoadBuilder builder(speed, mu, length);
  const int bends = reader.Integer(0, 3);
  for (int i = 0; i < 3; ++i) {
    const Bend bend = DrawBend(reader);
    if (i < bends) builder.AddBend(bend);
  }
  const Stretch stretch = DrawStretch(reader, length);
  control::Route route = builder.Finish(heading);
  control::RoadEdges edges = EdgesOf(route, layout.bounds, stretch);
  TrafficRoad road{.route = std::move(route), .edges = std::move(edges), .description = ""};
  road.description = Describe(road, layout.layout, speed, builder.bends());
  return road;
}

}  // namespace tools
