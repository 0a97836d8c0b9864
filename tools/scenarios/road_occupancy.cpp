#include "tools/scenarios/road_occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "control/road/keep_out.hpp"
#include "sim/road_body.hpp"

namespace tools {
namespace {

constexpr double kBeside = 0.1;  // free space on either side of the vehicle [m]
constexpr int kCells = 64;

// The cells first..last, as far as they exist.
LateralCells CellsBetween(int first, int last) {
  const int from = std::max(first, 0), to = std::min(last, kCells - 1);
  if (from > to) return 0;
  return (~LateralCells{0} >> (kCells - 1 - (to - from))) << from;
}

}  // namespace

RoadOccupancy::RoadOccupancy(const sim::Scenario& scenario, double until, double known_at)
    : scenario_(&scenario),
      ticks_(static_cast<int>(std::ceil(until / kTick))),
      stations_(static_cast<std::size_t>(std::ceil(scenario.route.length())) + 1),
      rightmost_(0.0) {
  const double half = scenario.footprint.half_width + kBeside;
  for (std::size_t i = 0; i < stations_; ++i)
    rightmost_ = std::min(rightmost_, scenario.road.At(static_cast<double>(i)).right + half);
  std::vector<LateralCells> road(stations_);
  for (std::size_t i = 0; i < stations_; ++i) {
    const control::RoadBounds bounds = scenario.road.At(static_cast<double>(i));
    const double first = (bounds.right + half - rightmost_) / kCell,
                 last = (bounds.left - half - rightmost_) / kCell;
    road[i] =
        CellsBetween(static_cast<int>(std::ceil(first - 1e-6)), static_cast<int>(std::floor(last + 1e-6)));
  }
  for (int tick = 0; tick <= ticks_; ++tick) free_.insert(free_.end(), road.begin(), road.end());
  for (const control::Obstacle& object : scenario.obstacles) {
    const auto appears = scenario.appears_at.find(object.id);
    const auto motion = scenario.motions.find(object.id);
    const bool from_behind = motion != scenario.motions.end() && motion->second.follows &&
                             motion->second.speed.front().speed > 0.0;
    const bool known = appears == scenario.appears_at.end() || appears->second <= known_at + 1e-9;
    if (known && !from_behind) Block(object);
  }
}

void RoadOccupancy::Block(const control::Obstacle& object) {
  const control::Footprint& vehicle = scenario_->footprint;
  const control::Route& route = scenario_->route;
  const auto motion = scenario_->motions.find(object.id);
  const auto gone = scenario_->disappears_at.find(object.id);
  std::optional<double> hint;
  for (int tick = 0; tick <= ticks_; ++tick) {
    const double time = tick * kTick;
    if (gone != scenario_->disappears_at.end() && time >= gone->second) return;
    control::Obstacle there;
    control::RouteProjection place;
    if (motion != scenario_->motions.end()) {
      const sim::RouteState state = sim::StateAt(motion->second, time);
      there = sim::OnRoute(object, route, motion->second.heading, state);
      place = {.s = state.s, .lateral = state.lateral};
    } else {
      there = control::Predict(object, time);
      place = route.Project({there.X, there.Y}, hint);
    }
    hint = place.s;
    const sim::RoadBody body = sim::ObjectOnRoad(there, route, place);
    const double half = vehicle.half_width + kBeside;
    const auto first = static_cast<int>(std::ceil((body.right - half - rightmost_) / kCell));
    const auto last = static_cast<int>(std::floor((body.left + half - rightmost_) / kCell));
    const double from = std::max(0.0, std::floor(body.rear - vehicle.front));
    const double to = std::min(static_cast<double>(stations_ - 1), std::ceil(body.front + vehicle.rear));
    const LateralCells blocked = CellsBetween(first, last);
    for (double s = from; s <= to; s += 1.0)
      free_[static_cast<std::size_t>(tick) * stations_ + static_cast<std::size_t>(s)] &= ~blocked;
  }
}

int RoadOccupancy::CellAt(double lateral) const {
  return static_cast<int>(std::clamp(std::round((lateral - rightmost_) / kCell), 0.0, kCells - 1.0));
}

}  // namespace tools
