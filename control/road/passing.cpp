#include "control/road/passing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/road/keep_out.hpp"
#include "control/vehicle/geometry.hpp"

namespace control {
namespace {

// Costs of a gap, in metres of lateral movement.
constexpr double kBeyondGrip = 20.0;  // per multiple of the grip by which the acceleration exceeds it
constexpr double kLacking = 50.0;     // per metre by which the gap is too narrow
constexpr double kChange = 2.0;       // per obstacle whose passing side changes
constexpr double kTooMuch = 15.0;     // above this cost, the vehicle stops instead

constexpr double kNoGap = std::numeric_limits<double>::infinity();

constexpr double kStoppedWithin = 0.1;  // [m]
// Hysteresis of the gap width [m]: a gap that was wide enough when it was chosen may be too narrow by up to kKept; a
// gap for which the vehicle is already stopping must be wider than necessary by at least kReopened.
constexpr double kKept = 0.15;
constexpr double kReopened = 0.1;

// The side on which obstacle k is passed in gap g.
Passage SideOf(std::size_t k, std::size_t g) {
  return k < g ? Passage::kLeft : Passage::kRight;
}

}  // namespace

Passage& PassingPlanner::Kept(const Obstacle& obstacle) {
  return kept_[static_cast<std::size_t>(obstacle.id) % kMostObstacles];
}

bool PassingPlanner::Allowed(const Obstacle& obstacle, Passage passage) const {
  return obstacle.side == PassingSide::kUnknown ||
         (obstacle.side == PassingSide::kLeft) == (passage == Passage::kLeft);
}

PassingPlanner::Meeting PassingPlanner::Meet(std::span<const Obstacle> obstacles, std::size_t index, double s,
                                             double upsilon, PassingDecision& decision) const {
  constexpr double kSlowest = 3.0;  // lowest speed assumed for the time until a meeting [m/s]
  const Obstacle& obstacle = obstacles[index];
  const RouteProjection place = profile_->Project({obstacle.X, obstacle.Y}, s);
  const double psi = profile_->At(place.s).psi;
  const Eigen::Vector2d along = Along(psi), left = LeftOf(psi);
  const Eigen::Vector2d velocity(obstacle.velocity_X, obstacle.velocity_Y);
  decision = {.passage = Passage::kIgnored,
              .s = place.s,
              .speed = along.dot(velocity),
              .half_length = SupportOf(obstacle, along)};
  const double behind = s - settings_.footprint.rear - settings_.margin;
  const double gap = place.s - decision.half_length - s - settings_.footprint.front;
  const auto time_at = [&](double speed) {
    if (gap <= 0.0) return 0.0;
    const double closing = std::max(speed, kSlowest) - decision.speed;
    return closing > 0.0 ? gap / closing : std::numeric_limits<double>::infinity();
  };
  const bool passed = place.s + decision.half_length < behind && decision.speed <= upsilon;
  // A vehicle that follows the obstacle at its speed never meets it, but would catch up if the obstacle were ignored.
  const double wanted = std::max(upsilon, profile_->At(s).speed);
  if (passed || !(time_at(wanted) <= settings_.look_ahead)) return {.index = index, .time = -1.0};
  const double time = std::min(time_at(upsilon), settings_.look_ahead);
  return {.index = index,
          .s = place.s + decision.speed * time,
          .time = time,
          .lateral = place.lateral + left.dot(velocity) * time,
          .half_length = decision.half_length,
          .half_width = SupportOf(obstacle, left)};
}

std::span<const PassingDecision> PassingPlanner::Decide(std::span<const Obstacle> obstacles, double s,
                                                        double lateral, double upsilon) {
  std::size_t count = 0;
  const std::size_t known = std::min(obstacles.size(), kMostObstacles);
  for (std::size_t k = 0; k < known; ++k) {
    meetings_[count] = Meet(obstacles, k, s, upsilon, decisions_[k]);
    if (meetings_[count].time >= 0.0) {
      ++count;
    } else {
      Kept(obstacles[k]) = Passage::kIgnored;
    }
  }
  const auto end = meetings_.begin() + static_cast<std::ptrdiff_t>(count);
  std::sort(meetings_.begin(), end,
            [](const Meeting& a, const Meeting& b) { return a.s - a.half_length < b.s - b.half_length; });

  // Obstacles that leave no room for the vehicle between them along the road are met together.
  const double length = settings_.footprint.front + settings_.footprint.rear + 2.0 * settings_.margin;
  double from = lateral;
  double time = 0.0;
  double distance = 0.0;
  for (auto first = meetings_.begin(); first != end;) {
    double group_end = first->s + first->half_length;
    auto last = first + 1;
    for (; last != end && last->s - last->half_length < group_end + length; ++last) {
      group_end = std::max(group_end, last->s + last->half_length);
    }
    distance = first->s - first->half_length - settings_.footprint.front - s;
    from = DecideGroup(obstacles, {first, last}, from, std::max(first->time - time, 0.1), distance, upsilon);
    time = first->time;
    first = last;
  }
  return {decisions_.data(), known};
}

double PassingPlanner::DecideGroup(std::span<const Obstacle> obstacles, std::span<Meeting> group, double from,
                                   double time, double distance, double upsilon) {
  std::sort(group.begin(), group.end(),
            [](const Meeting& a, const Meeting& b) { return a.lateral < b.lateral; });
  // The vehicle can stop within the remaining distance at 90 % of the grip; at a walking pace, it can stop anywhere.
  const bool can_stop = upsilon * upsilon < 1.8 * settings_.grip * std::max(distance, kStoppedWithin);
  double best_cost = kNoGap;
  double best_lateral = from;
  std::size_t best = 0;
  for (std::size_t g = 0; g <= group.size(); ++g) {
    const Gap gap = GapAt(obstacles, group, g);
    if (!gap.allowed || gap.lo - gap.hi > Spare(gap, can_stop)) continue;
    const GapUse use = Use(gap, from, time);
    if (use.cost < best_cost) {
      best_cost = use.cost;
      best_lateral = use.lateral;
      best = g;
    }
  }
  // If a gap needs more than the tyres can give, the vehicle stops, provided that it still can; if there is no gap,
  // it brakes in any case.
  const bool stop = best_cost == kNoGap || (best_cost > kTooMuch && can_stop);
  for (std::size_t k = 0; k < group.size(); ++k) {
    Passage& passage = decisions_[group[k].index].passage;
    passage = stop ? Passage::kStop : SideOf(k, best);
    Kept(obstacles[group[k].index]) = passage;
  }
  return best_lateral;
}

PassingPlanner::Gap PassingPlanner::GapAt(std::span<const Obstacle> obstacles, std::span<const Meeting> group,
                                          std::size_t g) {
  const double half_width = settings_.footprint.half_width;
  const double keep = half_width + settings_.margin;
  Gap gap{.lo = profile_->road().right + half_width + settings_.road_margin,
          .hi = profile_->road().left - half_width - settings_.road_margin};
  for (std::size_t k = 0; k < group.size(); ++k) {
    const Meeting& m = group[k];
    if (k < g) {
      gap.lo = std::max(gap.lo, m.lateral + m.half_width + keep);
    } else {
      gap.hi = std::min(gap.hi, m.lateral - m.half_width - keep);
    }
    const Obstacle& obstacle = obstacles[m.index];
    const Passage passage = SideOf(k, g), kept = Kept(obstacle);
    gap.allowed = gap.allowed && Allowed(obstacle, passage);
    gap.kept = gap.kept && kept == passage;
    gap.stopped = gap.stopped || kept == Passage::kStop;
    if ((kept == Passage::kLeft || kept == Passage::kRight) && kept != passage) ++gap.changes;
  }
  return gap;
}

double PassingPlanner::Spare(const Gap& gap, bool can_stop) const {
  // A vehicle that can no longer stop may use up the margins.
  if (!can_stop) return settings_.margin + std::min(settings_.margin, settings_.road_margin);
  if (gap.kept) return kKept;
  return gap.stopped ? -kReopened : 0.0;
}

PassingPlanner::GapUse PassingPlanner::Use(const Gap& gap, double from, double time) const {
  double lo = gap.lo, hi = gap.hi;
  const double lacking = std::max(lo - hi, 0.0);
  if (lacking > 0.0) lo = hi = 0.5 * (lo + hi);
  const double to = std::clamp(0.0, lo, hi);
  const double shift = std::abs(std::clamp(from, lo, hi) - from);
  // A lateral move of y within t needs an acceleration of 4 y/t².
  const double needed = 4.0 * shift / (time * time) / settings_.grip;
  const double cost = shift + std::abs(to) + kBeyondGrip * std::max(needed - 1.0, 0.0) + kLacking * lacking +
                      kChange * gap.changes;
  return {.cost = cost, .lateral = to};
}

}  // namespace control
