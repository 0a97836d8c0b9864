#include "tools/scenarios/space_time_way.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "tools/scenarios/road_occupancy.hpp"
#include "tools/scenarios/space_time_search.hpp"

namespace tools {
namespace {

constexpr double kFrictionShare = 0.7, kIntendedShare = 0.55;

// The ticks at which something is perceived after the start.
std::set<int> TicksOfNews(const sim::Scenario& scenario, double until) {
  std::set<int> news;
  for (const auto& [id, time] : scenario.appears_at) {
    if (time > 0.0 && time < until)
      news.insert(static_cast<int>(std::ceil(time / RoadOccupancy::kTick - 1e-6)));
  }
  return news;
}

}  // namespace

PossibleWay FindSpaceTimeWay(const sim::Scenario& scenario) {
  const double until = 2.0 * scenario.route.duration() + 10.0;
  const std::set<int> news = TicksOfNews(scenario, until);
  const RoadOccupancy truth(scenario, until, until);
  const control::RouteProjection place =
      scenario.route.Project({scenario.initial[control::kX], scenario.initial[control::kY]}, 0.0);
  const int path_cell = truth.CellAt(0.0);
  std::vector<PointMass> intended{{.tick = 0,
                                   .s = std::max(0.0, place.s),
                                   .speed = scenario.initial[control::kUpsilon],
                                   .cell = truth.CellAt(place.lateral)}};
  for (;;) {
    const int now = intended.front().tick;
    const RoadOccupancy known(scenario, until, now * RoadOccupancy::kTick);
    const SpaceTimeSearch search(scenario, known, kFrictionShare, intended);
    const PossibleWay way = search.way();
    const auto next = news.upper_bound(now);
    if (way != PossibleWay::kPass || next == news.end()) return way;
    const SpaceTimeSearch gentle(scenario, known, kIntendedShare, intended);
    const std::vector<PointMass> planned =
        (gentle.way() == PossibleWay::kPass ? gentle : search).FastestWay(path_cell);
    const auto then = std::ranges::find(planned, *next, &PointMass::tick);
    const bool touched = std::any_of(planned.begin(), then, [&](const PointMass& at) {
      return at.tick > now && (truth.Free(at.tick, at.s) >> at.cell & 1) == 0;
    });
    if (touched) return PossibleWay::kNone;
    if (then == planned.end() || then->s >= scenario.route.length()) return PossibleWay::kPass;
    intended.assign(then, planned.end());
  }
}

}  // namespace tools
