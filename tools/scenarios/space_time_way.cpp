#include "tools/scenarios/space_time_way.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <vector>

#include "tools/scenarios/road_occupancy.hpp"

namespace tools {
namespace {

constexpr double kFrictionShare = 0.7, kIntendedShare = 0.55;
constexpr double kShortestStep = 0.8;  // [s]
constexpr double kLeastSpacing = 0.4;  // of places along the road [m]
constexpr double kOverTarget = 1.02;   // highest speed: this times the target speed
// A cell per tick [m/s].
constexpr double kLateralSpeed = RoadOccupancy::kCell / RoadOccupancy::kTick;
constexpr double kLateralShare = 0.3;         // of the speed, at most
constexpr std::array kChanges{1, 0, -1, -2};  // of speed, in levels per step; the fastest first

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

struct PointMass {
  int tick = 0;
  double s = 0.0;
  double speed = 0.0;
  int cell = 0;
};

// From one start, among the objects of one occupancy. Speeds are whole levels, places whole spacings, and one step changes
// the speed by one level of `kChanges`, so that every step leads from a grid's point to another.
class Search {
 public:
  // `friction_share`: of μ g, the greatest acceleration. `intended`: what the vehicle was to do from the start on, at
  // every tick; not empty.
  Search(const sim::Scenario& scenario, const RoadOccupancy& occupancy, double friction_share,
         std::span<const PointMass> intended)
      : scenario_(&scenario),
        occupancy_(&occupancy),
        intended_(intended),
        start_(intended.front()),
        grip_(friction_share * scenario.plant.mu * sim::kGravity),
        step_ticks_(static_cast<int>(std::ceil(
            std::max(kShortestStep, 2.0 * std::sqrt(kLeastSpacing / grip_)) / RoadOccupancy::kTick - 1e-9))),
        step_(step_ticks_ * RoadOccupancy::kTick) {
    const double greatest = 0.5 * grip_ * step_;  // change of speed by one level
    start_level_ = static_cast<int>(std::ceil(start_.speed / greatest - 1e-9));
    level_ = start_level_ > 0 ? start_.speed / start_level_ : greatest;
    spacing_ = 0.5 * level_ * step_;
    double highest = start_.speed;
    for (double s = start_.s; s < scenario.route.length(); s += 1.0)
      highest = std::max(highest, kOverTarget * scenario.route.At(s).speed);
    levels_ = static_cast<int>(highest / level_ + 1e-9) + 1;
    places_ = static_cast<int>(std::ceil((scenario.route.length() - start_.s) / spacing_)) + 1;
    layers_ = std::max(1, (occupancy.ticks() - start_.tick) / step_ticks_);
    Survey();
    Solve();
  }

  [[nodiscard]] PossibleWay way() const {
    if ((At(pass_, 0, 0, start_level_) & Bit(start_.cell)) != 0) return PossibleWay::kPass;
    return (At(stop_, 0, 0, start_level_) & Bit(start_.cell)) != 0 ? PossibleWay::kStop : PossibleWay::kNone;
  }

  // The fastest way that passes, at every tick from the start to the route's end. way() must be kPass.
  [[nodiscard]] std::vector<PointMass> Way(int wanted_cell) const {
    std::vector<PointMass> way{start_};
    int place = 0, level = start_level_;
    for (int layer = 0; place < places_ - 1; ++layer) {
      const int change = FastestChange(layer, place, level, way.back().cell);
      const PointMass from = way.back();
      const LateralCells goal = At(pass_, layer + 1, place + 2 * level + change, level + change);
      for (int t = 1; t <= step_ticks_; ++t) {
        const double share = static_cast<double>(t) / step_ticks_;
        const LateralCells good = Backward(layer, place, level, change, t, goal);
        const LateralCells reached = Forward(layer, place, level, change, t, Bit(way.back().cell));
        way.push_back({.tick = from.tick + t,
                       .s = from.s + share * step_ * (level + 0.5 * share * change) * level_,
                       .speed = (level + share * change) * level_,
                       .cell = Nearest(reached & good, wanted_cell)});
      }
      place += 2 * level + change;
      level += change;
    }
    return way;
  }

 private:
  struct Station {
    double curvature;
    double highest;  // speed [m/s]
  };

  void Survey() {
    for (int place = 0; place < places_; ++place) {
      const control::RoutePoint point = scenario_->route.At(start_.s + place * spacing_);
      stations_.push_back({.curvature = std::abs(point.curvature), .highest = kOverTarget * point.speed});
    }
  }

  [[nodiscard]] std::size_t Index(int layer, int place, int level) const {
    return (static_cast<std::size_t>(layer) * static_cast<std::size_t>(places_) +
            static_cast<std::size_t>(place)) *
               static_cast<std::size_t>(levels_) +
           static_cast<std::size_t>(level);
  }
  [[nodiscard]] LateralCells At(const std::vector<LateralCells>& cells, int layer, int place,
                                int level) const {
    if (place >= places_ - 1) return ~LateralCells{0};  // beyond the end
    return cells[Index(layer, place, level)];
  }

  // Whether the speed may change by `change` levels: within grip, and not above the highest speed unless it falls.
  [[nodiscard]] bool Allowed(int place, int level, int change) const {
    const int after = level + change;
    if (after < 0 || after >= levels_ || (after == 0 && level == 0 && change != 0)) return false;
    const Station& here = stations_[static_cast<std::size_t>(place)];
    const Station& there =
        stations_[static_cast<std::size_t>(std::min(place + 2 * level + change, places_ - 1))];
    if (change >= 0 && after * level_ > std::max(there.highest, 1e-9)) return false;
    const double along = change * level_ / step_;
    const auto holds = [&](double speed, double curvature) {
      const double across = speed * speed * curvature;
      return along * along + across * across <= grip_ * grip_ * (1.0 + 1e-9);
    };
    // The start may be amid a step of the search before it, and so at a speed that this one would not choose.
    return (place == 0 || holds(level * level_, here.curvature)) && holds(after * level_, there.curvature);
  }

  // The cells that are free `t` ticks into a step, and within reach of what was intended.
  [[nodiscard]] LateralCells FreeAt(int layer, int place, int level, int change, int t) const {
    const double share = static_cast<double>(t) / step_ticks_;
    const double s = start_.s + place * spacing_ + share * step_ * (level + 0.5 * share * change) * level_;
    const int since = layer * step_ticks_ + t;
    const double time = since * RoadOccupancy::kTick;
    const double reach = 0.25 * grip_ * time * time / RoadOccupancy::kCell;
    LateralCells cells = occupancy_->Free(start_.tick + since, s);
    if (reach < 64.0) {
      const int cell = intended_[std::min(static_cast<std::size_t>(since), intended_.size() - 1)].cell;
      const int low = std::max(0, cell - static_cast<int>(reach));
      const int high = std::min(63, cell + static_cast<int>(reach));
      cells &= (~LateralCells{0} >> (63 - (high - low))) << low;
    }
    return cells;
  }

  // Whether the vehicle can move sideways by a cell at tick `t` of a step.
  [[nodiscard]] bool Shifts(int level, int change, int t) const {
    const double speed = (level + 0.5 * change) * level_;
    const int shifts = static_cast<int>(step_ticks_ * std::min(1.0, kLateralShare * speed / kLateralSpeed));
    return t * shifts / step_ticks_ > (t - 1) * shifts / step_ticks_;
  }

  [[nodiscard]] LateralCells Forward(int layer, int place, int level, int change, int t,
                                     LateralCells from) const {
    return (Shifts(level, change, t) ? Widened(from) : from) & FreeAt(layer, place, level, change, t);
  }

  // The cells `from` ticks into a step from which it leads to `goal`.
  [[nodiscard]] LateralCells Backward(int layer, int place, int level, int change, int from,
                                      LateralCells goal) const {
    for (int t = step_ticks_; t > from && goal != 0; --t) {
      goal &= FreeAt(layer, place, level, change, t);
      if (Shifts(level, change, t)) goal = Widened(goal);
    }
    return goal;
  }

  void Solve() {
    const std::size_t size = Index(layers_ + 1, 0, 0);
    pass_.assign(size, 0);
    stop_.assign(size, 0);
    for (int layer = layers_; layer >= 0; --layer) {
      for (int place = 0; place < places_ - 1; ++place) {
        stop_[Index(layer, place, 0)] = ~LateralCells{0};
        if (layer == layers_) continue;
        for (int level = 0; level < levels_; ++level) Solve(layer, place, level);
      }
    }
  }

  void Solve(int layer, int place, int level) {
    LateralCells &pass = pass_[Index(layer, place, level)], &stop = stop_[Index(layer, place, level)];
    for (const int change : kChanges) {
      if (!Allowed(place, level, change)) continue;
      const int next = place + 2 * level + change;
      pass |= Backward(layer, place, level, change, 0, At(pass_, layer + 1, next, level + change));
      stop |= Backward(layer, place, level, change, 0, At(stop_, layer + 1, next, level + change));
    }
  }

  [[nodiscard]] int FastestChange(int layer, int place, int level, int cell) const {
    return *std::ranges::find_if(kChanges, [&](int change) {
      if (!Allowed(place, level, change)) return false;
      const LateralCells goal = At(pass_, layer + 1, place + 2 * level + change, level + change);
      return (Backward(layer, place, level, change, 0, goal) & Bit(cell)) != 0;
    });
  }

  const sim::Scenario* scenario_;
  const RoadOccupancy* occupancy_;
  std::span<const PointMass> intended_;
  PointMass start_;
  double grip_;     // [m/s²]
  int step_ticks_;  // ticks of a step
  double step_;     // [s]
  int start_level_ = 0;
  double level_ = 0.0;    // [m/s]
  double spacing_ = 0.0;  // [m]
  int levels_ = 0, places_ = 0, layers_ = 0;
  std::vector<Station> stations_;
  std::vector<LateralCells> pass_, stop_;  // cells from which there is such a way, by layer, place and level
};

}  // namespace

PossibleWay FindSpaceTimeWay(const sim::Scenario& scenario) {
  const double until = 2.0 * scenario.route.duration() + 10.0;
  std::set<int> news;  // ticks at which something is perceived
  for (const auto& [id, time] : scenario.appears_at) {
    if (time > 0.0 && time < until)
      news.insert(static_cast<int>(std::ceil(time / RoadOccupancy::kTick - 1e-6)));
  }
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
    const Search search(scenario, known, kFrictionShare, intended);
    const PossibleWay way = search.way();
    const auto next = news.upper_bound(now);
    if (way != PossibleWay::kPass || next == news.end()) return way;
    const Search gentle(scenario, known, kIntendedShare, intended);
    const std::vector<PointMass> planned =
        (gentle.way() == PossibleWay::kPass ? gentle : search).Way(path_cell);
    const auto then = std::ranges::find(planned, *next, &PointMass::tick);
    const bool touched = std::any_of(planned.begin(), then, [&](const PointMass& at) {
      return at.tick > now && (truth.Free(at.tick, at.s) & Bit(at.cell)) == 0;
    });
    if (touched) return PossibleWay::kNone;
    if (then == planned.end()) return PossibleWay::kPass;
    intended.assign(then, planned.end());
  }
}

}  // namespace tools
