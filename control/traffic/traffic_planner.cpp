#include "control/traffic/traffic_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace control {
namespace {

constexpr double kWorthwhile = 1.0;  // cost from which going is compared with staying behind [s]
constexpr double kHysteresis = 0.7;  // [s]
constexpr int kReopened = 4;         // cycles for which the way must be free before the vehicle goes again
constexpr int kGivenUp = 4;          // cycles after which a way for which the vehicle is late is given up
constexpr double kNearPath = 0.5;    // offset from its path up to which the vehicle is taken to be on it [m]

}  // namespace

TrafficPlanner::TrafficPlanner(const TrafficSettings& settings, const RoadProfile& profile)
    : settings_(settings), search_(settings, profile) {}

void TrafficPlanner::Reset() {
  search_.Reset();
  kept_by_id_.fill(Side::kNone);
  stays_behind_ = false;
  open_cycles_ = late_cycles_ = 0;
  manoeuvre_ = {};
}

Side& TrafficPlanner::Kept(const Obstacle& obstacle) {
  return kept_by_id_[static_cast<std::size_t>(obstacle.id) % kIds];
}

LateralPoint TrafficPlanner::Start(const RoadPosition& vehicle) const {
  const LateralPoint last = manoeuvre_.path.At(vehicle.s);
  if (std::abs(last.offset - vehicle.lateral) < kNearPath)
    return {.offset = last.offset, .slope = last.slope};
  return {.offset = vehicle.lateral, .slope = vehicle.slope};
}

const Manoeuvre& TrafficPlanner::Plan(std::span<const Obstacle> obstacles, const RoadPosition& vehicle) {
  search_.Begin(obstacles, vehicle, Start(vehicle));
  const auto objects = search_.objects().objects();
  const bool yielded = manoeuvre_.decision == Decision::kYield;
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const Obstacle& obstacle = obstacles[objects[k].index];
    kept_[k] = Kept(obstacle);
    if (yielded && obstacle.id == manoeuvre_.object && objects[k].crosses) search_.YieldTo(k);
  }
  const double decided = stays_behind_ ? 0.0 : settings_.t_s * open_cycles_;
  search_.Go(kept_, Caution::kUsual, decided, go_);

  // The object behind which the vehicle could stay instead.
  std::optional<std::size_t> ahead = go_.blocker;
  if (go_.possible) {
    for (std::size_t k = 0; k < objects.size() && !ahead; ++k) {
      if (go_.way.side[k] != Side::kNone && objects[k].s > vehicle.s) ahead = k;
    }
  }
  const bool compare = !go_.possible || (ahead && go_.cost > search_.FreeTime() + kWorthwhile);
  bool stay = !go_.possible;
  Reason reason = go_.obstacle;
  behind_.possible = false;
  if (compare || stays_behind_) {
    behind_.way.reached = go_.way.reached;
    search_.StayBehind(ahead, kept_, behind_);
    if (go_.possible && behind_.possible) {
      // Waiting behind what stands would never end.
      stay = ahead && objects[*ahead].Moves() &&
             behind_.cost < go_.cost + (stays_behind_ ? kHysteresis : -kHysteresis);
      if (compare || stay) reason = stay ? Reason::kPassingGainsLittle : Reason::kStayingCosts;
    } else if (go_.possible && compare) {
      reason = Reason::kCannotStay;
    }
  }
  // A way that was free is not given up because of a single cycle.
  late_cycles_ = go_.late ? late_cycles_ + 1 : 0;
  if (!stays_behind_ && go_.late && late_cycles_ < kGivenUp && search_.CanStop(behind_)) {
    stay = false;
    reason = Reason::kLateForNow;
  }
  open_cycles_ = stay ? 0 : open_cycles_ + 1;
  if (!stay && stays_behind_ && behind_.possible && open_cycles_ < kReopened) {
    stay = true;
    reason = Reason::kOpenTooShort;
  }

  if (!stay) {
    Take(go_, ahead ? Decision::kPass : Decision::kDrive, reason, ahead, obstacles);
  } else if (search_.CanStop(behind_)) {
    Decision decision = Decision::kWait;
    if (behind_.stop_count > 0 && behind_.stop_objects[0] < objects.size()) {
      const RoadObject& object = objects[behind_.stop_objects[0]];
      ahead = behind_.stop_objects[0];
      if (object.Moves()) decision = object.MovesAhead() ? Decision::kFollow : Decision::kYield;
    }
    Take(behind_, decision, reason, ahead, obstacles);
  } else {
    const bool late = go_.blocker && objects[*go_.blocker].Moves();
    if (late) search_.Go(kept_, Caution::kNoSpare, decided, go_);
    const bool passes = late && go_.possible;
    if (!passes) search_.Go(kept_, Caution::kSqueeze, decided, go_);
    Take(go_.possible ? go_ : behind_, passes ? Decision::kPass : Decision::kSqueeze,
         go_.possible ? Reason::kTooLateToStop : Reason::kNoWay, ahead, obstacles);
    stay = !go_.possible;
  }
  stays_behind_ = stay;
  return manoeuvre_;
}

void TrafficPlanner::Take(const Candidate& candidate, Decision decision, Reason reason,
                          std::optional<std::size_t> object, std::span<const Obstacle> obstacles) {
  const auto objects = search_.objects().objects();
  const bool passes = decision == Decision::kPass || decision == Decision::kSqueeze;
  manoeuvre_.decision = decision;
  manoeuvre_.reason = reason;
  manoeuvre_.object = object ? obstacles[objects[*object].index].id : -1;
  manoeuvre_.passed = object && passes ? candidate.way.side[*object] : Side::kNone;
  manoeuvre_.path = candidate.path;
  manoeuvre_.speed_limit = candidate.speed_limit;
  manoeuvre_.stop_lines = candidate.stop_lines;
  manoeuvre_.stop_objects = candidate.stop_objects;
  manoeuvre_.stop_count = candidate.stop_count;
  manoeuvre_.objects = objects;
  manoeuvre_.side = candidate.way.side;
  manoeuvre_.left_out = search_.objects().left_out();
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
      const double s = search_.stations().At(j);
      if (!o.IsBeside(settings_.footprint, o.SAt(candidate.speeds.t[j]) - s)) continue;
      const double shrunk = usual.At(candidate.way.gap[j].share);
      manoeuvre_.margin[k] = std::min(manoeuvre_.margin[k], manoeuvre_.Yielding(s, squeezed * shrunk));
    }
    Kept(obstacles[o.index]) = candidate.way.side[k];
  }
}

}  // namespace control
