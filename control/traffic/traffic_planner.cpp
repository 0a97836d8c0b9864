#include "control/traffic/traffic_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace control {
namespace {

constexpr double kShortest = 40.0;    // least length of road that is planned for [m]
constexpr double kMoving = 0.5;       // speed from which an object moves [m/s]
constexpr double kSameTimes = 0.3;    // difference of arrival times that does not matter [s]
constexpr double kWorthwhile = 1.0;   // cost from which going is compared with staying behind [s]
constexpr double kHysteresis = 0.7;   // [s]
constexpr int kReopened = 4;          // cycles for which the way must be free before the vehicle goes again
constexpr int kGivenUp = 4;           // cycles after which a way for which the vehicle is late is given up
constexpr double kShareOfGrip = 0.9;  // of the grip that a path may use
constexpr double kNearPath = 0.5;     // offset from its path up to which the vehicle is taken to be on it [m]

}  // namespace

TrafficPlanner::TrafficPlanner(const TrafficSettings& settings, const RoadProfile& profile)
    : settings_(settings),
      profile_(&profile),
      objects_(settings.footprint, settings.horizon, profile),
      corridor_({.footprint = settings.footprint,
                 .obstacle_margin = settings.obstacle_margin,
                 .road_margin = settings.road_margin,
                 .grip = settings.grip},
                profile),
      smoother_(settings.path) {}

void TrafficPlanner::Reset() {
  kept_by_id_.fill(Side::kNone);
  stays_behind_ = false;
  open_cycles_ = late_cycles_ = 0;
  manoeuvre_ = {};
}

// Places the stations and reads the road's values there.
void TrafficPlanner::Measure(const RoadPosition& vehicle) {
  const double accelerated = vehicle.speed + 0.5 * profile_->limits().acceleration * settings_.horizon;
  const double fastest = std::max(std::min(accelerated, profile_->At(vehicle.s).speed), vehicle.speed);
  stations_ = {
      .s_0 = vehicle.s,
      .spacing = std::max(fastest * settings_.horizon, kShortest) / static_cast<double>(kStations - 1)};
  for (std::size_t j = 0; j < kStations; ++j) {
    const RoutePoint point = profile_->At(stations_.At(j));
    road_speed_[j] = point.speed;
    curvature_[j] = point.curvature;
  }
}

LateralPoint TrafficPlanner::Start(const RoadPosition& vehicle) const {
  const LateralPoint last = manoeuvre_.path.At(vehicle.s);
  if (std::abs(last.offset - vehicle.lateral) < kNearPath)
    return {.offset = last.offset, .slope = last.slope};
  return {.offset = vehicle.lateral, .slope = vehicle.slope};
}

void TrafficPlanner::LimitSpeed(Candidate& candidate) const {
  const double grip = kShareOfGrip * settings_.grip;
  for (std::size_t j = 0; j < kStations; ++j) {
    double limit = road_speed_[j];
    const double stretch = std::max(1.0 - curvature_[j] * candidate.path.offset[j], 0.2);
    const double curvature = std::abs(curvature_[j] / stretch + candidate.path.bend[j]);
    if (curvature > std::abs(curvature_[j]))
      limit = std::min(limit, std::sqrt(grip / std::max(curvature, 1e-6)));
    if (j > 0 && j < candidate.way.reached) limit = std::min(limit, candidate.way.gap[j].speed);
    candidate.speed_limit[j] = limit;
  }
  for (std::size_t j = kStations - 1; j-- > 0;) {
    const double next = candidate.speed_limit[j + 1];
    candidate.speed_limit[j] =
        std::min(candidate.speed_limit[j],
                 std::sqrt(next * next + 2.0 * profile_->limits().deceleration * stations_.spacing));
  }
}

// Whether the path touches an object at the times of the speed plan; if so, which. What the vehicle touches already does not
// count: it can only drive on.
bool TrafficPlanner::Collides(const Candidate& candidate, std::size_t& object) {
  const auto& speeds = candidate.speeds;
  const Footprint& footprint = settings_.footprint;
  const auto touches = [&](const RoadObject& o, double s, double t) {
    const double ahead = o.SAt(t) - s;
    return ahead - o.half_length <= footprint.front && ahead + o.half_length >= -footprint.rear &&
           std::abs(candidate.path.At(s).offset - o.LateralAt(t)) < o.half_width + footprint.half_width;
  };
  constexpr int kParts = 4;  // of the way between two stations
  for (std::size_t j = 1; j < std::min(speeds.count, candidate.way.reached); ++j) {
    for (const std::size_t k : corridor_.Beside(stations_, objects_.objects(), speeds, j, 0.0)) {
      const RoadObject& o = objects_.objects()[k];
      if (touches(o, stations_.s_0, 0.0)) continue;
      for (int part = 1; part <= kParts; ++part) {
        const double share = static_cast<double>(part) / kParts;
        if (touches(o, stations_.At(j - 1) + share * stations_.spacing,
                    std::lerp(speeds.t[j - 1], speeds.t[j], share))) {
          object = k;
          return true;
        }
      }
    }
  }
  return false;
}

// In seconds: the time to the last station, lateral offsets and accelerations, and changed sides.
double TrafficPlanner::Cost(const Candidate& candidate) const {
  constexpr double kOffset = 0.02, kAcceleration = 0.05;  // per second and m², (m/s²)²
  const SpeedPlan& speeds = candidate.speeds;
  double cost = candidate.way.changes;
  for (std::size_t j = 1; j < speeds.count; ++j) {
    const double dt = speeds.t[j] - speeds.t[j - 1];
    const double d = candidate.path.offset[j], a = speeds.v[j] * speeds.v[j] * candidate.path.bend[j];
    cost += dt * (kOffset * d * d + kAcceleration * a * a);
  }
  const std::size_t last = speeds.count - 1;
  const double left = stations_.length() - static_cast<double>(last) * stations_.spacing;
  const double usual = std::max(road_speed_[last], 1.0);
  return cost + (last + 1 == kStations ? speeds.t[last] : settings_.horizon + left / usual);
}

std::optional<std::size_t> TrafficPlanner::Blocker(const Candidate& candidate, const RoadPosition& vehicle) {
  const std::size_t j = candidate.way.reached;
  std::optional<std::size_t> blocker;
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::size_t k : corridor_.Beside(stations_, objects_.objects(), candidate.speeds, j, 0.0)) {
    const RoadObject& object = objects_.objects()[k];
    const double near = object.s - object.half_length;
    if (near < vehicle.s - settings_.footprint.rear) continue;  // it comes from behind
    // The vehicle is beside it already and cannot stay behind it.
    if (near < vehicle.s + settings_.footprint.front && std::hypot(object.speed, object.drift) < kMoving &&
        std::abs(object.lateral - vehicle.lateral) > object.half_width + settings_.footprint.half_width) {
      continue;
    }
    // Of a standing and an oncoming object that block the road together, the vehicle waits behind the standing one.
    const double from = object.speed < -kMoving && !object.crosses ? near + settings_.horizon * 100.0 : near;
    if (from < nearest) {
      nearest = from;
      blocker = k;
    }
  }
  return blocker;
}

void TrafficPlanner::AddStop(std::optional<std::size_t> object, const RoadPosition& vehicle,
                             Candidate& candidate) const {
  if (candidate.stop_count == Manoeuvre::kMostStops) return;
  StopLine line{.s = stations_.At(candidate.way.reached) - stations_.spacing - settings_.footprint.front};
  if (object) {
    const RoadObject& o = objects_.objects()[*object];
    const double front = o.s - o.half_length - settings_.footprint.front - settings_.stop_gap;
    if (!o.crosses && o.speed > kMoving) {
      line = {
          .s = front - settings_.headway * o.speed, .speed = o.speed, .spare = settings_.headway * o.speed};
    } else if (!o.crosses && o.speed < -kMoving) {
      line = {.s = std::min(
                  front, vehicle.s + 0.5 * vehicle.speed * vehicle.speed / profile_->limits().deceleration)};
    } else {
      line = {.s = front};
    }
  }
  candidate.stop_lines[candidate.stop_count] = line;
  candidate.stop_objects[candidate.stop_count] = object.value_or(RoadObjects::kMost);
  ++candidate.stop_count;
}

bool TrafficPlanner::CanStop(const Candidate& candidate, const RoadPosition& vehicle) const {
  for (std::size_t k = 0; k < candidate.stop_count; ++k) {
    const StopLine& line = candidate.stop_lines[k];
    const double closing = std::max(vehicle.speed - line.speed, 0.0);
    const double room = line.s + line.spare + 0.8 * settings_.stop_gap - vehicle.s;
    if (closing * closing > 1.8 * settings_.grip * std::max(room, 0.1)) return false;
  }
  return true;
}

void TrafficPlanner::Evaluate(const RoadPosition& vehicle, bool squeeze, Candidate& candidate) {
  const auto objects = objects_.objects();
  const std::span stops(candidate.stop_lines.data(), candidate.stop_count);
  candidate.possible = candidate.late = false;
  candidate.blocker.reset();
  candidate.speeds =
      PlanSpeed(stations_, road_speed_, stops, vehicle.speed, profile_->limits(), settings_.horizon);
  for (int round = 0; round < 2; ++round) {
    corridor_.Find(stations_, vehicle, objects, kept_, candidate.speeds, settings_.horizon, squeeze,
                   candidate.way);
    const bool blocked = candidate.way.reached < candidate.speeds.count;
    if (blocked) candidate.blocker = Blocker(candidate, vehicle);
    if (!smoother_.Smooth(stations_, Start(vehicle), candidate.way, candidate.speeds, curvature_,
                          candidate.path)) {
      return;
    }
    LimitSpeed(candidate);
    if (blocked) return;
    const SpeedPlan before = candidate.speeds;
    candidate.speeds = PlanSpeed(stations_, candidate.speed_limit, stops, vehicle.speed, profile_->limits(),
                                 settings_.horizon);
    double later = 0.0;
    for (std::size_t j = 0; j < std::min(before.count, candidate.speeds.count); ++j) {
      later = std::max(later, std::abs(candidate.speeds.t[j] - before.t[j]));
    }
    if (later < kSameTimes) break;
  }
  std::size_t touched = 0;
  if (Collides(candidate, touched)) {
    candidate.blocker = touched;
    const RoadObject& object = objects[*candidate.blocker];
    candidate.late = std::hypot(object.speed, object.drift) > kMoving;
    return;
  }
  candidate.possible = true;
  candidate.cost = Cost(candidate);
}

void TrafficPlanner::EvaluateBehind(const RoadPosition& vehicle, std::optional<std::size_t> object,
                                    Candidate& candidate) {
  while (candidate.stop_count < Manoeuvre::kMostStops) {
    AddStop(object, vehicle, candidate);
    Evaluate(vehicle, false, candidate);
    if (candidate.possible || !candidate.blocker) return;
    object = candidate.blocker;
    const auto known = std::span(candidate.stop_objects).first(candidate.stop_count);
    if (std::ranges::find(known, *object) != known.end()) return;
  }
}

const Manoeuvre& TrafficPlanner::Plan(std::span<const Obstacle> obstacles, const RoadPosition& vehicle) {
  Measure(vehicle);
  objects_.Select(obstacles, vehicle, stations_.length());
  const auto objects = objects_.objects();
  for (std::size_t k = 0; k < objects.size(); ++k) {
    kept_[k] = kept_by_id_[static_cast<std::size_t>(obstacles[objects[k].index].id) % kIds];
  }
  go_.stop_count = behind_.stop_count = 0;
  Evaluate(vehicle, false, go_);

  // The object behind which the vehicle could stay instead.
  std::optional<std::size_t> ahead = go_.blocker;
  if (go_.possible) {
    for (std::size_t k = 0; k < objects.size() && !ahead; ++k) {
      if (go_.way.side[k] != Side::kNone && objects[k].s > vehicle.s) ahead = k;
    }
  }
  const double free_time = stations_.length() / std::max(road_speed_[0], 1.0);
  const bool compare = !go_.possible || (ahead && go_.cost > free_time + kWorthwhile);
  bool stay = !go_.possible;
  behind_.possible = false;
  if (compare || stays_behind_) {
    behind_.way.reached = go_.way.reached;
    EvaluateBehind(vehicle, ahead, behind_);
    if (go_.possible && behind_.possible) {
      stay = ahead && behind_.cost < go_.cost + (stays_behind_ ? kHysteresis : -kHysteresis);
    }
  }
  // A way that was free is not given up because of a single cycle.
  late_cycles_ = go_.late ? late_cycles_ + 1 : 0;
  if (!stays_behind_ && go_.late && late_cycles_ < kGivenUp && CanStop(behind_, vehicle)) stay = false;
  open_cycles_ = stay ? 0 : open_cycles_ + 1;
  if (stays_behind_ && behind_.possible && open_cycles_ < kReopened) stay = true;

  if (!stay) {
    const Decision decision = ahead ? Decision::kPass : Decision::kDrive;
    Take(go_, decision, ahead, obstacles);
  } else if (CanStop(behind_, vehicle)) {
    Decision decision = Decision::kWait;
    if (behind_.stop_count > 0 && behind_.stop_objects[0] < objects.size()) {
      const RoadObject& object = objects[behind_.stop_objects[0]];
      ahead = behind_.stop_objects[0];
      if (!object.crosses && object.speed > kMoving)
        decision = Decision::kFollow;
      else if (std::hypot(object.speed, object.drift) > kMoving)
        decision = Decision::kYield;
    }
    Take(behind_, decision, ahead, obstacles);
  } else {
    go_.stop_count = 0;
    Evaluate(vehicle, true, go_);
    Take(go_.possible ? go_ : behind_, Decision::kSqueeze, ahead, obstacles);
    stay = !go_.possible;
  }
  stays_behind_ = stay;
  return manoeuvre_;
}

void TrafficPlanner::Take(const Candidate& candidate, Decision decision, std::optional<std::size_t> object,
                          std::span<const Obstacle> obstacles) {
  const auto objects = objects_.objects();
  manoeuvre_.decision = decision;
  manoeuvre_.object = object && *object < objects.size() ? obstacles[objects[*object].index].id : -1;
  manoeuvre_.path = candidate.path;
  manoeuvre_.speed_limit = candidate.speed_limit;
  manoeuvre_.stop_lines = candidate.stop_lines;
  manoeuvre_.stop_objects = candidate.stop_objects;
  manoeuvre_.stop_count = candidate.stop_count;
  manoeuvre_.objects = objects;
  manoeuvre_.side = candidate.way.side;
  manoeuvre_.left_out = objects_.left_out();
  for (std::size_t j = 0; j < kStations; ++j) {
    const bool bounded = j > 0 && j < candidate.way.reached;
    manoeuvre_.play[j] = bounded ? std::max(candidate.way.gap[j].hi - candidate.way.gap[j].lo, 0.0)
                                 : std::numeric_limits<double>::infinity();
    manoeuvre_.share[j] = bounded ? candidate.way.gap[j].share : 1.0;
  }
  const double squeezed = decision == Decision::kSqueeze ? 0.0 : 1.0;
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const RoadObject& o = objects[k];
    const Margin usual = MarginTo(o.object_class, candidate.speeds.v[0], settings_.obstacle_margin);
    manoeuvre_.margin[k] = squeezed * usual.wanted;
    for (std::size_t j = 1; j < std::min(candidate.speeds.count, candidate.way.reached); ++j) {
      const double ahead = o.SAt(candidate.speeds.t[j]) - stations_.At(j);
      if (ahead - o.half_length > settings_.footprint.front) continue;
      if (ahead + o.half_length < -settings_.footprint.rear) continue;
      const double shrunk = usual.least + candidate.way.gap[j].share * (usual.wanted - usual.least);
      manoeuvre_.margin[k] =
          std::min(manoeuvre_.margin[k], manoeuvre_.Yielding(stations_.At(j), squeezed * shrunk));
    }
    kept_by_id_[static_cast<std::size_t>(obstacles[o.index].id) % kIds] = candidate.way.side[k];
  }
}

}  // namespace control
