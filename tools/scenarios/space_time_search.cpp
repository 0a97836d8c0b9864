#include "tools/scenarios/space_time_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tools {
namespace {

constexpr double kTick = RoadOccupancy::kTick;
constexpr double kShortestStep = 0.8;                           // [s]
constexpr double kLeastSpacing = 0.4;                           // of places along the road [m]
constexpr double kOverTarget = 1.02;                            // highest speed: this times the target speed
constexpr double kLateralSpeed = RoadOccupancy::kCell / kTick;  // [m/s]
constexpr double kLateralShare = 0.3;                           // of the speed, at most

LateralCells Widened(LateralCells cells) {
  return cells | cells << 1 | cells >> 1;
}

LateralCells Bit(int cell) {
  return LateralCells{1} << cell;
}

// The set cell nearest to `wanted`. `cells` must not be empty.
int Nearest(LateralCells cells, int wanted) {
  for (int off = 0;; ++off) {
    for (const int cell : {wanted - off, wanted + off}) {
      if (cell >= 0 && cell < 64 && (cells & Bit(cell)) != 0) return cell;
    }
  }
}

int StepTicks(double grip) {
  return static_cast<int>(
      std::ceil(std::max(kShortestStep, 2.0 * std::sqrt(kLeastSpacing / grip)) / kTick - 1e-9));
}

}  // namespace

SpaceTimeSearch::SpaceTimeSearch(const sim::Scenario& scenario, const RoadOccupancy& occupancy,
                                 double friction_share, std::span<const PointMass> intended)
    : occupancy_(&occupancy),
      intended_(intended),
      start_(intended.front()),
      length_(scenario.route.length()),
      grip_(friction_share * scenario.plant.mu * sim::kGravity),
      step_ticks_(StepTicks(grip_)),
      step_(step_ticks_ * kTick) {
  const double greatest = 0.5 * grip_ * step_;  // change of speed by one level
  start_level_ = static_cast<int>(std::ceil(start_.speed / greatest - 1e-9));
  level_ = start_level_ > 0 ? start_.speed / start_level_ : greatest;
  spacing_ = 0.5 * level_ * step_;
  double highest = start_.speed;
  for (double s = start_.s; s < length_; s += 1.0)
    highest = std::max(highest, kOverTarget * scenario.route.At(s).speed);
  levels_ = static_cast<int>(highest / level_ + 1e-9) + 1;
  places_ = static_cast<int>(std::ceil((length_ - start_.s) / spacing_)) + 1;
  layers_ = std::max(1, (occupancy.ticks() - start_.tick) / step_ticks_);
  SetMoves();
  SetLimits(scenario);
  SetWindows();
  Solve();
}

void SpaceTimeSearch::SetMoves() {
  moves_.resize(static_cast<std::size_t>(levels_));
  for (int level = 0; level < levels_; ++level) {
    for (const int change : kChanges) {
      if (level + change < 0 || level + change >= levels_) continue;
      Move move{.change = change, .after = level + change, .advance = 2 * level + change, .ticks = {{}}};
      const double speed = (level + 0.5 * change) * level_;
      const int shifts = static_cast<int>(step_ticks_ * std::min(1.0, kLateralShare * speed / kLateralSpeed));
      for (int t = 1; t <= step_ticks_; ++t) {
        const double share = static_cast<double>(t) / step_ticks_;
        move.ticks.push_back({.ahead = share * step_ * (level + 0.5 * share * change) * level_,
                              .shifts = t * shifts / step_ticks_ > (t - 1) * shifts / step_ticks_});
      }
      moves_[static_cast<std::size_t>(level)].push_back(std::move(move));
    }
  }
}

void SpaceTimeSearch::SetLimits(const sim::Scenario& scenario) {
  const auto level = [&](double speed) {
    return static_cast<int>(std::min(speed / level_ + 1e-9, static_cast<double>(levels_)));
  };
  for (int place = 0; place < places_; ++place) {
    const control::RoutePoint point = scenario.route.At(start_.s + place * spacing_);
    Limits limits{.target = level(kOverTarget * point.speed)};
    for (int change = 0; change < 3; ++change) {
      const double along = change * level_ / step_;
      const double across = std::sqrt(std::max(0.0, grip_ * grip_ * (1.0 + 1e-9) - along * along));
      limits.grip[static_cast<std::size_t>(change)] =
          level(std::sqrt(across / std::max(std::abs(point.curvature), 1e-9)));
    }
    limits_.push_back(limits);
  }
}

void SpaceTimeSearch::SetWindows() {
  for (int since = 0; since <= (layers_ + 1) * step_ticks_; ++since) {
    const double time = since * kTick;
    const double reach = std::min(64.0, 0.25 * grip_ * time * time / RoadOccupancy::kCell);
    const int cell = intended_[std::min(static_cast<std::size_t>(since), intended_.size() - 1)].cell;
    const int low = std::max(0, cell - static_cast<int>(reach));
    const int high = std::min(63, cell + static_cast<int>(reach));
    windows_.push_back((~LateralCells{0} >> (63 - (high - low))) << low);
  }
}

// Within grip, and not above the target speed unless the speed falls.
bool SpaceTimeSearch::Allowed(int place, int level, const Move& move) const {
  const auto change = static_cast<std::size_t>(std::abs(move.change));
  const Limits& here = limits_[static_cast<std::size_t>(place)];
  const Limits& there = limits_[static_cast<std::size_t>(std::min(place + move.advance, places_ - 1))];
  if (move.change >= 0 && move.after > there.target) return false;
  // The start may be amid a step of an earlier search, and so at a speed that this one would not choose.
  return (place == 0 || level <= here.grip[change]) && move.after <= there.grip[change];
}

std::size_t SpaceTimeSearch::Index(int layer, int place, int level) const {
  return (static_cast<std::size_t>(layer) * static_cast<std::size_t>(places_) +
          static_cast<std::size_t>(place)) *
             static_cast<std::size_t>(levels_) +
         static_cast<std::size_t>(level);
}

SpaceTimeSearch::Ways SpaceTimeSearch::At(int layer, int place, int level) const {
  if (place >= places_ - 1) return {.pass = ~LateralCells{0}, .stop = ~LateralCells{0}};  // beyond the end
  return ways_[Index(layer, place, level)];
}

LateralCells SpaceTimeSearch::FreeAt(int layer, int place, const Move& move, int t) const {
  const int since = layer * step_ticks_ + t;
  const double s = start_.s + place * spacing_ + move.ticks[static_cast<std::size_t>(t)].ahead;
  return occupancy_->Free(start_.tick + since, s) & windows_[static_cast<std::size_t>(since)];
}

SpaceTimeSearch::Ways SpaceTimeSearch::Before(int layer, int place, const Move& move, int from,
                                              Ways goal) const {
  for (int t = step_ticks_; t > from && (goal.pass | goal.stop) != 0; --t) {
    const LateralCells free = FreeAt(layer, place, move, t);
    goal = {.pass = goal.pass & free, .stop = goal.stop & free};
    if (move.ticks[static_cast<std::size_t>(t)].shifts)
      goal = {.pass = Widened(goal.pass), .stop = Widened(goal.stop)};
  }
  return goal;
}

void SpaceTimeSearch::Solve() {
  ways_.assign(Index(layers_ + 1, 0, 0), {});
  for (int layer = layers_; layer >= 0; --layer) {
    for (int place = 0; place < places_ - 1; ++place) {
      for (int level = 0; level < levels_; ++level) {
        Ways& ways = ways_[Index(layer, place, level)];
        if (level == 0) ways.stop = ~LateralCells{0};
        if (layer == layers_) continue;
        for (const Move& move : moves_[static_cast<std::size_t>(level)]) {
          if (!Allowed(place, level, move)) continue;
          const Ways before = Before(layer, place, move, 0, At(layer + 1, place + move.advance, move.after));
          ways = {.pass = ways.pass | before.pass, .stop = ways.stop | before.stop};
        }
      }
    }
  }
}

PossibleWay SpaceTimeSearch::way() const {
  const Ways ways = At(0, 0, start_level_);
  if ((ways.pass & Bit(start_.cell)) != 0) return PossibleWay::kPass;
  return (ways.stop & Bit(start_.cell)) != 0 ? PossibleWay::kStop : PossibleWay::kNone;
}

const SpaceTimeSearch::Move& SpaceTimeSearch::FastestMove(int layer, int place, int level, int cell) const {
  return *std::ranges::find_if(moves_[static_cast<std::size_t>(level)], [&](const Move& move) {
    if (!Allowed(place, level, move)) return false;
    const Ways goal = At(layer + 1, place + move.advance, move.after);
    return (Before(layer, place, move, 0, goal).pass & Bit(cell)) != 0;
  });
}

std::vector<PointMass> SpaceTimeSearch::FastestWay(int wanted_cell) const {
  std::vector<PointMass> way{start_};
  int place = 0, level = start_level_;
  for (int layer = 0; place < places_ - 1; ++layer) {
    const PointMass from = way.back();
    const Move& move = FastestMove(layer, place, level, from.cell);
    const Ways goal = At(layer + 1, place + move.advance, move.after);
    for (int t = 1; t <= step_ticks_; ++t) {
      const Tick& tick = move.ticks[static_cast<std::size_t>(t)];
      const LateralCells near = tick.shifts ? Widened(Bit(way.back().cell)) : Bit(way.back().cell);
      const LateralCells good = FreeAt(layer, place, move, t) & Before(layer, place, move, t, goal).pass;
      way.push_back({.tick = from.tick + t,
                     .s = from.s + tick.ahead,
                     .speed = from.speed + (move.after - level) * level_ * t / step_ticks_,
                     .cell = Nearest(near & good, wanted_cell)});
    }
    place += move.advance;
    level = move.after;
  }
  return way;
}

}  // namespace tools
