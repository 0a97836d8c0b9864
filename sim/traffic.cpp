#include "sim/traffic.hpp"

#include <algorithm>
#include <cmath>

#include "control/road/keep_out.hpp"
#include "control/vehicle/geometry.hpp"
#include "sim/follower.hpp"

namespace sim {
namespace {

constexpr double kRounding = 1e-9;  // of a time [s]

template <typename T>
std::optional<T> Find(const std::map<int, T>& by_id, int id) {
  const auto found = by_id.find(id);
  return found == by_id.end() ? std::nullopt : std::optional<T>(found->second);
}

}  // namespace

Traffic::Traffic(const Scenario& scenario) : route_(scenario.route), footprint_(scenario.footprint) {
  for (const control::Obstacle& obstacle : scenario.obstacles) {
    Object object{.start = obstacle,
                  .motion = Find(scenario.motions, obstacle.id),
                  .place = {},
                  .appears_at = Find(scenario.appears_at, obstacle.id).value_or(0.0),
                  .disappears_at = Find(scenario.disappears_at, obstacle.id)};
    if (object.motion) object.place = StateAt(*object.motion, 0.0);
    objects_.push_back(std::move(object));
  }
}

void Traffic::Advance(double time, const control::State& z) {
  const double duration = time - time_;
  time_ = time;
  const bool followed = std::ranges::any_of(
      objects_, [](const Object& object) { return object.motion && object.motion->follows; });
  if (!followed || !z.allFinite()) return;
  const control::RouteProjection place = route_.Project(control::Position(z), hint_);
  hint_ = place.s;
  const RoadBody vehicle = VehicleOnRoad(z, footprint_, route_, place);
  for (Object& object : objects_) {
    if (object.motion && object.motion->follows) Follow(object, vehicle, duration);
  }
}

void Traffic::Follow(Object& follower, const RoadBody& vehicle, double duration) const {
  RouteState& place = follower.place;
  const double desired = follower.motion->speed.front().speed;
  const double direction = desired < 0.0 ? -1.0 : 1.0;
  const RoadBody body = ObjectOnRoad(OnRoute(follower.start, route_, follower.motion->heading, place), route_,
                                     {.s = place.s, .lateral = place.lateral});
  std::optional<Leader> leader;
  if (InSameLane(body, vehicle) && direction * (vehicle.s - body.s) > 0.0) {
    const double gap = direction > 0.0 ? vehicle.rear - body.front : body.rear - vehicle.front;
    leader = {.gap = gap, .speed = direction * vehicle.speed};
  }
  const double speed = direction * place.speed;
  const double acceleration = FollowerAcceleration(speed, direction * desired, leader);
  // Constant over the cycle, but a follower that has come to a stop does not roll back.
  const double moving = acceleration < 0.0 ? std::min(duration, -speed / acceleration) : duration;
  place.s += direction * (speed + 0.5 * acceleration * moving) * moving;
  place.speed = direction * std::max(speed + acceleration * moving, 0.0);
  ShiftTo(*follower.motion, time_, place);
}

control::Obstacle Traffic::Where(const Object& object) const {
  if (!object.motion) return control::Predict(object.start, time_);
  const RouteState place = object.motion->follows ? object.place : StateAt(*object.motion, time_);
  return OnRoute(object.start, route_, object.motion->heading, place);
}

std::vector<control::Obstacle> Traffic::Now() const {
  std::vector<control::Obstacle> present;
  present.reserve(objects_.size());
  for (const Object& object : objects_) {
    if (!object.disappears_at || time_ < *object.disappears_at - kRounding) present.push_back(Where(object));
  }
  return present;
}

bool Traffic::IsPerceived(int id) const {
  const auto object = std::ranges::find(objects_, id, [](const Object& o) { return o.start.id; });
  return object == objects_.end() || time_ >= object->appears_at - kRounding;
}

}  // namespace sim
