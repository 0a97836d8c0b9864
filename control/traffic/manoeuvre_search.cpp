#include "control/traffic/manoeuvre_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace control {
namespace {

constexpr double kShortest = 40.0;    // least length of road that is planned for [m]
constexpr double kSameTimes = 0.3;    // difference of arrival times that does not matter [s]
constexpr double kSlowest = 1.0;      // speed that the road allows, where costs are compared, at least [m/s]
constexpr double kWidest = 1.08;      // spacing of the stations at most, as a share of the one that is needed
constexpr double kShareOfGrip = 0.9;  // of the grip that a path may use

}  // namespace

ManoeuvreSearch::ManoeuvreSearch(const TrafficSettings& settings, const RoadProfile& profile)
    : settings_(settings),
      profile_(&profile),
      objects_(settings.footprint, settings.horizon, profile),
      corridor_({.footprint = settings.footprint,
                 .obstacle_margin = settings.obstacle_margin,
                 .road_margin = settings.road_margin},
                profile),
      smoother_(settings.path) {
  SetGrip(settings.grip);
}

void ManoeuvreSearch::SetGrip(double grip) {
  settings_.grip = grip;
  limits_ = WithinGrip(profile_->limits(), grip);
  corridor_.SetGrip(grip, HardDeceleration(limits_));
}

void ManoeuvreSearch::Begin(std::span<const Obstacle> obstacles, const RoadPosition& vehicle,
                            const LateralPoint& start) {
  vehicle_ = vehicle;
  start_ = start;
  Measure();
  objects_.Select(obstacles, vehicle, stations_.length());
}

// Places the stations and reads the road's values there.
void ManoeuvreSearch::Measure() {
  const double accelerated = vehicle_.speed + 0.5 * limits_.acceleration * settings_.horizon;
  const double fastest =
      std::max(std::min(accelerated, profile_->SpeedWithin(settings_.grip, vehicle_.s)), vehicle_.speed);
  // The first point may be as near as half of the spacing, which is kept as long as it fits.
  const double least =
      std::max(fastest * settings_.horizon, kShortest) / (static_cast<double>(kStations) - 1.5);
  const double spacing = stations_.spacing;
  const bool fits = spacing >= least && spacing <= kWidest * least;
  stations_ = Stations::OnGrid(vehicle_.s, fits ? spacing : 0.5 * (1.0 + kWidest) * least);
  for (std::size_t j = 0; j < kStations; ++j) {
    road_speed_[j] = profile_->SpeedWithin(settings_.grip, stations_.At(j));
    curvature_[j] = profile_->At(stations_.At(j)).curvature;
  }
}

void ManoeuvreSearch::Go(std::span<const Side> kept, Caution caution, double decided, Candidate& candidate) {
  constexpr double kTimeToLeave = 3.0, kSpare = 0.6;  // [s]
  leaves_ = std::max(kTimeToLeave - decided, 0.0);
  candidate.stop_count = 0;
  Evaluate(kept,
           {.squeeze = caution == Caution::kSqueeze,
            .waits = settings_.horizon,
            .leaves = leaves_,
            .spare = caution == Caution::kUsual ? kSpare : 0.0},
           candidate);
}

void ManoeuvreSearch::StayBehind(std::optional<std::size_t> object, std::span<const Side> kept,
                                 Candidate& candidate) {
  candidate.stop_count = 0;
  while (candidate.stop_count < Manoeuvre::kMostStops) {
    AddStop(object, candidate);
    Evaluate(kept, {.waits = settings_.horizon}, candidate);
    if (candidate.possible || !candidate.blocker) return;
    object = candidate.blocker;
    const auto known = std::span(candidate.stop_objects).first(candidate.stop_count);
    if (std::ranges::find(known, *object) != known.end()) return;
  }
}

bool ManoeuvreSearch::CanStop(const Candidate& candidate) const {
  for (std::size_t k = 0; k < candidate.stop_count; ++k) {
    const StopLine& line = candidate.stop_lines[k];
    const double closing = std::max(vehicle_.speed - line.speed, 0.0);
    const double room = line.s + line.spare + 0.8 * settings_.stop_gap - vehicle_.s;
    if (closing * closing > 1.8 * settings_.grip * std::max(room, 0.1)) return false;
  }
  return true;
}

// Time from station j to the last one at the road's speed [s].
double ManoeuvreSearch::TimeFrom(std::size_t j) const {
  double time = 0.0;
  for (++j; j < kStations; ++j) time += stations_.Step(j - 1) / std::max(road_speed_[j], kSlowest);
  return time;
}

void ManoeuvreSearch::Evaluate(std::span<const Side> kept, const WayTerms& terms, Candidate& candidate) {
  const auto objects = objects_.objects();
  const std::span stops(candidate.stop_lines.data(), candidate.stop_count);
  candidate.possible = candidate.late = false;
  candidate.obstacle = Reason::kWayFree;
  candidate.blocker.reset();
  const auto plan_speeds = [&](const StationValues& allowed) {
    return PlanSpeed(stations_, allowed, stops, vehicle_.speed, limits_, settings_.horizon);
  };
  candidate.speeds = plan_speeds(road_speed_);
  candidate.speed_limit = road_speed_;
  candidate.path = {};
  KeepAbleToStop(candidate);
  candidate.speeds = plan_speeds(candidate.speed_limit);
  constexpr int kUsualRounds = 2, kMostRounds = 3;
  for (int round = 0; round < kMostRounds; ++round) {
    corridor_.Find(stations_, vehicle_, objects, kept, candidate.speeds, terms, candidate.way);
    const bool blocked = candidate.way.reached < candidate.speeds.count;
    if (blocked) {
      candidate.blocker = Blocker(kept, terms, candidate);
      candidate.obstacle = Obstruction(kept, terms, candidate);
    }
    if (!smoother_.Smooth(stations_, start_, candidate.way, candidate.speeds, curvature_, candidate.path)) {
      if (!blocked) candidate.obstacle = Reason::kNoPath;
      return;
    }
    LimitSpeed(candidate);
    if (blocked) return;
    const SpeedPlan before = candidate.speeds;
    candidate.speeds = plan_speeds(candidate.speed_limit);
    double later = 0.0;
    for (std::size_t j = 0; j < std::min(before.count, candidate.speeds.count); ++j) {
      later = std::max(later, std::abs(candidate.speeds.t[j] - before.t[j]));
    }
    // Another way is searched for if the vehicle would get farther than this one leads.
    const bool searched = candidate.speeds.count <= candidate.way.reached;
    if (searched && (later < kSameTimes || round + 1 == kUsualRounds)) break;
  }
  candidate.blocker = Touched(candidate);
  if (candidate.blocker) {
    candidate.late = objects[*candidate.blocker].Moves();
    candidate.obstacle = candidate.late ? Reason::kTooLate : Reason::kNoPath;
    return;
  }
  candidate.possible = true;
  candidate.cost = Cost(candidate);
}

void ManoeuvreSearch::LimitSpeed(Candidate& candidate) const {
  const double grip = kShareOfGrip * settings_.grip;
  for (std::size_t j = 0; j < kStations; ++j) {
    double limit = road_speed_[j];
    const double stretch = std::max(1.0 - curvature_[j] * candidate.path.offset[j], 0.2);
    const double curvature = std::abs(curvature_[j] / stretch + candidate.path.bend[j]);
    if (curvature > std::abs(curvature_[j]))
      limit = std::min(limit, std::sqrt(grip / std::max(curvature, 1e-6)));
    if (j > 1) {
      // From one bend to the next, the wheels are turned within a spacing.
      const double change = std::abs(candidate.path.bend[j] - candidate.path.bend[j - 1]);
      limit = std::min(limit, settings_.curvature_rate * stations_.spacing / std::max(change, 1e-6));
    }
    if (j > 0 && j < candidate.way.reached) limit = std::min(limit, candidate.way.gap[j].speed);
    candidate.speed_limit[j] = limit;
  }
  KeepAbleToStop(candidate);
  LimitInTime(stations_, candidate.speed_limit, limits_.deceleration);
}

// The vehicle must be able to stop in case another does: behind an object that moves ahead, until it has had time to leave the
// object's lane, and before one that crosses, as long as that may come to a stop on the path.
void ManoeuvreSearch::KeepAbleToStop(Candidate& candidate) const {
  constexpr double kLeaves = 1.0;  // time in which the lane is left at last [s]
  constexpr double kApart = 0.3;   // gap to one that crosses that leaves no doubt [m]
  const SpeedPlan& speeds = candidate.speeds;
  for (const RoadObject& o : objects_.objects()) {
    const bool ahead =
        o.MovesAhead() && o.s > vehicle_.s && Covers(o, vehicle_.lateral, 0.0, RoadObject::kDrift, 0.0);
    const bool crosses = o.crosses && o.Moves() && candidate.path.exists;
    if (!ahead && !crosses) continue;
    const double brakes = ahead ? StopLine::HardestStop(o.speed) : 0.0;
    for (std::size_t j = 0; j < speeds.count; ++j) {
      const double s = stations_.At(j), t = speeds.t[j];
      const double room = o.SAt(t) + brakes - o.half_length - settings_.footprint.front - s;
      if (room < -settings_.footprint.front || (ahead && t > std::max(leaves_, kLeaves))) break;
      const double then = t + room / std::max(speeds.v[j], 1.0);
      if (crosses && !Covers(o, candidate.path.At(o.SAt(t)).offset, t, then, kApart)) continue;
      candidate.speed_limit[j] =
          std::min(candidate.speed_limit[j], StoppingSpeed(room, HardDeceleration(limits_)));
    }
  }
}

// True if a vehicle with its centre at this lateral position is nearer than `apart` [m] to a place where the object is between
// two times [s].
bool ManoeuvreSearch::Covers(const RoadObject& o, double lateral, double from, double to,
                             double apart) const {
  const double a = o.LateralAt(from), b = o.LateralAt(to);
  const double half = o.half_width + settings_.footprint.half_width + apart;
  return lateral > std::min(a, b) - half && lateral < std::max(a, b) + half;
}

// What the vehicle touches already does not count: it can only drive on.
std::optional<std::size_t> ManoeuvreSearch::Touched(const Candidate& candidate) {
  const auto& speeds = candidate.speeds;
  const Footprint& footprint = settings_.footprint;
  const auto touches = [&](const RoadObject& o, double s, double t) {
    return o.IsBeside(footprint, o.SAt(t) - s) &&
           std::abs(candidate.path.At(s).offset - o.LateralAt(t)) < o.half_width + footprint.half_width;
  };
  constexpr int kParts = 4;  // of the way between two stations
  for (std::size_t j = 1; j < std::min(speeds.count, candidate.way.reached); ++j) {
    for (const std::size_t k : corridor_.Beside(stations_, objects_.objects(), speeds, j)) {
      const RoadObject& o = objects_.objects()[k];
      if (touches(o, stations_.s_0, 0.0)) continue;
      for (int part = 1; part <= kParts; ++part) {
        const double share = static_cast<double>(part) / kParts;
        if (touches(o, stations_.At(j - 1) + share * stations_.Step(j - 1),
                    std::lerp(speeds.t[j - 1], speeds.t[j], share))) {
          return k;
        }
      }
    }
  }
  return std::nullopt;
}

// In seconds: the time to the last station, lateral offsets and accelerations, changed sides, and what the vehicle will lose
// because it is slower than the road allows at the end.
double ManoeuvreSearch::Cost(const Candidate& candidate) const {
  constexpr double kOffset = 0.02, kAcceleration = 0.05;  // per second and m², (m/s²)²
  constexpr double kLasts = 5.0;                          // time for which a lower speed is taken to last [s]
  const SpeedPlan& speeds = candidate.speeds;
  double cost = candidate.way.changes;
  for (std::size_t j = 1; j < speeds.count; ++j) {
    const double dt = speeds.t[j] - speeds.t[j - 1];
    const double d = candidate.path.offset[j], a = speeds.v[j] * speeds.v[j] * candidate.path.bend[j];
    cost += dt * (kOffset * d * d + kAcceleration * a * a);
  }
  const std::size_t last = speeds.count - 1;
  const double usual = std::max(road_speed_[last], kSlowest);
  cost += kLasts * std::max(1.0 - speeds.v[last] / usual, 0.0);
  return cost + (last + 1 == kStations ? speeds.t[last] : settings_.horizon + TimeFrom(last));
}

std::optional<std::size_t> ManoeuvreSearch::Blocker(std::span<const Side> kept, const WayTerms& terms,
                                                    const Candidate& candidate) {
  const std::size_t j = candidate.way.reached;
  std::optional<std::size_t> blocker;
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::size_t k : corridor_.Beside(stations_, objects_.objects(), candidate.speeds, j,
                                              {.leaves = terms.leaves, .spare = terms.spare}, kept)) {
    const RoadObject& object = objects_.objects()[k];
    const double near = object.s - object.half_length;
    if (near < vehicle_.s - settings_.footprint.rear) continue;  // it comes from behind
    // The vehicle is beside it already and cannot stay behind it.
    if (near < vehicle_.s + settings_.footprint.front && !object.Moves() &&
        std::abs(object.lateral - vehicle_.lateral) > object.half_width + settings_.footprint.half_width) {
      continue;
    }
    // Of a standing and an oncoming object that block the road together, the vehicle waits behind the standing one.
    const double from = object.ComesTowards() ? near + settings_.horizon * 100.0 : near;
    if (from < nearest) {
      nearest = from;
      blocker = k;
    }
  }
  return blocker;
}

// Of several causes that come together, the one counts that passes soonest.
Reason ManoeuvreSearch::Obstruction(std::span<const Side> kept, const WayTerms& terms,
                                    const Candidate& candidate) {
  const auto objects = objects_.objects();
  const std::size_t reached = candidate.way.reached;
  Reason reason = Reason::kRoadTooNarrow;
  // What is met a little before or after the way's end may have closed the lane in which it would lead on.
  constexpr std::size_t kAround = 5;  // stations
  for (std::size_t j = std::max(reached, kAround + 1) - kAround;
       j < std::min(reached + kAround + 1, candidate.speeds.count); ++j) {
    for (const std::size_t k : corridor_.Beside(stations_, objects, candidate.speeds, j,
                                                {.leaves = terms.leaves, .spare = terms.spare}, kept)) {
      if (objects[k].ComesTowards()) return Reason::kOncomingFirst;
      if (objects[k].crosses && objects[k].Moves()) {
        reason = Reason::kCrossingFirst;
      } else if (reason == Reason::kRoadTooNarrow) {
        reason = Reason::kNoGap;
      }
    }
  }
  return reason;
}

void ManoeuvreSearch::AddStop(std::optional<std::size_t> object, Candidate& candidate) const {
  StopLine line{.s = stations_.At(candidate.way.reached - 1) - settings_.footprint.front};
  if (object) {
    const RoadObject& o = objects_.objects()[*object];
    const double front = o.s - o.half_length - settings_.footprint.front - settings_.stop_gap;
    if (o.MovesAhead()) {
      line = {
          .s = front - settings_.headway * o.speed, .speed = o.speed, .spare = settings_.headway * o.speed};
    } else if (o.ComesTowards()) {
      line = {.s =
                  std::min(front, vehicle_.s + 0.5 * vehicle_.speed * vehicle_.speed / limits_.deceleration)};
    } else {
      line = {.s = front};
    }
  }
  candidate.stop_lines[candidate.stop_count] = line;
  candidate.stop_objects[candidate.stop_count] = object.value_or(RoadObjects::kMost);
  ++candidate.stop_count;
}

}  // namespace control
