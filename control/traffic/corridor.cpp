#include "control/traffic/corridor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace control {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

constexpr double kOffCentre = 0.02;    // cost of a lateral offset, per second and m² [1/m²]
constexpr double kMovement = 0.04;     // cost of a lateral velocity, per second and (m/s)² [s²/m²]
constexpr double kLateralSpeed = 2.0;  // lateral velocity above which the vehicle has to slow down [m/s]
constexpr double kSteepest = 0.45;     // largest slope of a way
constexpr double kChange = 0.7;        // cost of passing an object on another side than before [s]
constexpr double kUnfinished =
    3.0;  // cost of being beside an object at the end, per metre off the centre [s/m]
constexpr double kBeyondGrip = 6.0;    // cost of a lateral move per second and multiple of the grip beyond it
constexpr double kSpeedAtEdge = 40.0;  // speed at which the usual margin to the road's edges is wanted [m/s]
constexpr double kOtherSide = 1e3;     // where an object that must be passed on one side seems to end [m]

// Distance at which the vehicle can just stop behind an object that brakes [m].
double WayToStopBehind(double speed, double object_speed, double deceleration) {
  return 0.5 * speed * speed / deceleration - StopLine::HardestStop(object_speed);
}

bool IsKept(std::span<const Side> kept, std::size_t k) {
  return k < kept.size() && kept[k] != Side::kNone;
}

// Where an object may be while the vehicle is between stations j − 1 and j.
struct Encounter {
  double from, to;              // times [s]
  double ahead_from, ahead_to;  // distances of its centre from the vehicle's then [m]
};

// `kept`: the previous way counted with the object.
Encounter EncounterWith(const RoadObject& object, const Stations& stations, const SpeedPlan& speeds,
                        std::size_t j, const WayTerms& terms, bool kept) {
  const bool ahead = object.MovesAhead() && object.s > stations.s_0;
  const double spare = kept || ahead || !object.Moves() ? 0.0 : (object.yielded_to ? 2.0 : 1.0) * terms.spare;
  const double from = object.Since(std::max(speeds.t[j - 1] - spare, 0.0));
  const double to = std::max(speeds.t[j], terms.waits) + spare;
  return {.from = from,
          .to = to,
          .ahead_from = object.SAt(from) - stations.At(j - 1),
          .ahead_to = object.SAt(to) - stations.At(j)};
}

// What an object ahead covers that is passed on `side`: its lane is left at once, but no faster than is comfortable. The
// vehicle covers `ahead` [m] within the time t [s].
void LeaveLane(Side side, const RoadPosition& vehicle, double ahead, double t, double half_width,
               Covered& covered) {
  constexpr double kComfortable = 1.0;  // lateral acceleration [m/s²]
  const double apart = half_width + covered.margin.wanted;
  const double straight = vehicle.lateral + vehicle.slope * ahead;
  const double moved = 0.5 * kComfortable * t * t;
  if (side == Side::kLeft) {
    covered.left = std::min(covered.left, straight + moved - apart);
    covered.right = -kOtherSide;
  } else {
    covered.right = std::max(covered.right, straight - moved + apart);
    covered.left = kOtherSide;
  }
}

}  // namespace

std::span<const std::size_t> Corridor::Beside(const Stations& stations, std::span<const RoadObject> objects,
                                              const SpeedPlan& speeds, std::size_t j, const WayTerms& terms,
                                              std::span<const Side> kept) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const RoadObject& object = objects[k];
    const Encounter met = EncounterWith(object, stations, speeds, j, terms, IsKept(kept, k));
    const bool near = met.from > terms.leaves && object.MovesAhead() && met.ahead_to > 0.0 &&
                      met.ahead_to - object.half_length - settings_.footprint.front <
                          WayToStopBehind(speeds.v[j], object.speed, settings_.deceleration);
    if (near || object.IsBeside(settings_.footprint, met.ahead_from, met.ahead_to)) beside_[count++] = k;
  }
  return {beside_.data(), count};
}

// The road's bounds where they are narrowest between the vehicle's ends and on the way since the last station.
RoadBounds Corridor::NarrowestAt(double s, double step) const {
  const double from = s - std::max(settings_.footprint.rear, step), to = s + settings_.footprint.front;
  constexpr int kSamples = 5;
  RoadBounds narrowest = profile_->RoadAt(from);
  for (int k = 1; k < kSamples; ++k) {
    const RoadBounds road = profile_->RoadAt(from + k * (to - from) / (kSamples - 1));
    narrowest = {.left = std::min(narrowest.left, road.left), .right = std::max(narrowest.right, road.right)};
  }
  return narrowest;
}

void Corridor::FindGaps(const Stations& stations, const RoadPosition& vehicle,
                        std::span<const RoadObject> objects, std::span<const Side> kept,
                        const SpeedPlan& speeds, std::size_t j, const WayTerms& terms) {
  const auto beside = Beside(stations, objects, speeds, j, terms, kept);
  // In a bend, the ends of the vehicle reach further out than its middle.
  const double end = std::max(settings_.footprint.front, settings_.footprint.rear);
  const double half_width =
      settings_.footprint.half_width + 0.5 * std::abs(profile_->At(stations.At(j)).curvature) * end * end;
  const double present_gap_time = 0.5;  // objects beside the vehicle now keep the distance that they have [s]
  std::size_t count = 0;
  for (const std::size_t k : beside) {
    const RoadObject& object = objects[k];
    const Encounter met = EncounterWith(object, stations, speeds, j, terms, IsKept(kept, k));
    const double from = object.LateralAt(met.from), to = object.LateralAt(met.to);
    Margin margin = MarginTo(object.object_class, speeds.v[j], settings_.obstacle_margin);
    if (speeds.t[j - 1] < present_gap_time) {
      const double apart = std::abs(vehicle.lateral - object.lateral) - object.half_width - half_width;
      margin.wanted = std::clamp(apart, 0.0, margin.wanted);
      margin.least = std::min(margin.least, margin.wanted);
    }
    if (terms.squeeze) margin.wanted = margin.least = std::min(0.05, margin.least);
    Covered covered{
        .right = object.side == PassingSide::kLeft ? -kOtherSide : std::min(from, to) - object.half_width,
        .left = object.side == PassingSide::kRight ? kOtherSide : std::max(from, to) + object.half_width,
        .margin = margin};
    if (IsKept(kept, k) && !object.IsBeside(settings_.footprint, met.ahead_from, met.ahead_to))
      LeaveLane(kept[k], vehicle, stations.At(j) - stations.s_0, speeds.t[j], half_width, covered);
    covered_[count++] = covered;
  }
  const RoadBounds road = NarrowestAt(stations.At(j), stations.Step(j - 1));
  const double edge = terms.squeeze ? 0.0 : std::min(0.05, settings_.road_margin);
  const Covered outside{
      .right = road.left,
      .left = road.right,
      .margin = {
          .least = edge, .wanted = terms.squeeze ? edge : settings_.road_margin, .speed = kSpeedAtEdge}};
  gaps_[j].Find(outside, {covered_.data(), count}, half_width);
}

void Corridor::Reach(std::size_t j, const Stations& stations, const RoadPosition& vehicle,
                     std::span<const RoadObject> objects, std::span<const Side> kept,
                     const SpeedPlan& speeds) {
  const double ds = stations.Step(j - 1), dt = std::max(speeds.t[j] - speeds.t[j - 1], 1e-3);
  const auto gaps = gaps_[j].gaps();
  const int most = static_cast<int>(std::floor(kSteepest * ds / step_)) + 1;
  std::size_t gap = 0;
  for (int l = 0; l < kCells; ++l) {
    Cell& cell = cells_[j][static_cast<std::size_t>(l)];
    cell = {.cost = kNever};
    const double centre = rightmost_ + l * step_;
    while (gap < gaps.size() && gaps[gap].hi < centre - 0.5 * step_) ++gap;
    if (gap == gaps.size() || gaps[gap].lo > centre + 0.5 * step_) continue;
    const double lateral = std::clamp(centre, gaps[gap].lo, gaps[gap].hi);
    double own = dt * kOffCentre * lateral * lateral + std::max(ds / gaps[gap].speed - dt, 0.0);
    // Near the vehicle, a way is limited by what the tyres can do: a lateral move of y within t takes 4 y/t².
    const double t = std::max(speeds.t[j], 0.1);
    const double move = std::abs(lateral - vehicle.lateral - vehicle.slope * (stations.At(j) - stations.s_0));
    own += kBeyondGrip * std::max(4.0 * move / (t * t) / settings_.grip - 1.0, 0.0) * dt;
    for (std::size_t k = 0; k < objects.size(); ++k) {
      if (!met_[k] || kept[k] == Side::kNone) continue;
      const Side side = lateral > objects[k].LateralAt(speeds.t[j]) ? Side::kLeft : Side::kRight;
      if (side != kept[k]) own += kChange;
    }
    const int first = j == 1 ? 0 : std::max(l - most, 0), last = j == 1 ? 0 : std::min(l + most, kCells - 1);
    for (int from = first; from <= last; ++from) {
      const Cell& before = cells_[j - 1][static_cast<std::size_t>(from)];
      if (before.cost == kNever) continue;
      const double move_here = std::abs(lateral - static_cast<double>(before.lateral));
      if (move_here > kSteepest * ds + step_) continue;
      const double cost = static_cast<double>(before.cost) + own + kMovement * move_here * move_here / dt +
                          std::max(move_here / kLateralSpeed - dt, 0.0);
      if (cost < static_cast<double>(cell.cost)) {
        cell = {.cost = static_cast<float>(cost),
                .lateral = static_cast<float>(lateral),
                .from = static_cast<short>(from),
                .gap = static_cast<short>(gap)};
      }
    }
  }
}

void Corridor::Find(const Stations& stations, const RoadPosition& vehicle,
                    std::span<const RoadObject> objects, std::span<const Side> kept, const SpeedPlan& speeds,
                    const WayTerms& terms, Way& way) {
  RoadBounds widest = profile_->RoadAt(vehicle.s);
  for (std::size_t j = 1; j < kStations; ++j) {
    const RoadBounds road = profile_->RoadAt(stations.At(j));
    widest = {.left = std::max(widest.left, road.left), .right = std::min(widest.right, road.right)};
  }
  rightmost_ = widest.right + settings_.footprint.half_width;
  step_ = std::max((widest.left - settings_.footprint.half_width - rightmost_) / (kCells - 1), 1e-3);
  for (Cell& cell : cells_[0]) cell = {.cost = kNever};
  cells_[0][0] = {.cost = 0.0F, .lateral = static_cast<float>(vehicle.lateral)};
  std::array<bool, RoadObjects::kMost> seen{};
  const bool waits = speeds.count < kStations && speeds.v[speeds.count - 1] < 1.0;
  std::size_t reached = 1;
  for (std::size_t j = 1; j < speeds.count; ++j) {
    const bool last = j + 1 == speeds.count;
    WayTerms here = terms;
    if (!last || !waits) here.waits = 0.0;
    FindGaps(stations, vehicle, objects, kept, speeds, j, here);
    met_.fill(false);
    for (const std::size_t k : Beside(stations, objects, speeds, j, {.leaves = terms.leaves})) {
      met_[k] = !seen[k];
      seen[k] = true;
    }
    Reach(j, stations, vehicle, objects, kept, speeds);
    const bool open = std::ranges::any_of(cells_[j], [](const Cell& cell) { return cell.cost < kNever; });
    if (!open) break;
    reached = j + 1;
  }
  way.reached = reached;
  way.side.fill(Side::kNone);
  way.changes = 0.0;
  way.lateral.fill(vehicle.lateral);
  if (reached == 1) return;
  // An overtaking manoeuvre should end within the horizon.
  double best = std::numeric_limits<double>::infinity();
  int l = 0;
  const auto at_end = Beside(stations, objects, speeds, reached - 1);
  const bool unfinished = std::ranges::any_of(
      at_end, [&](std::size_t k) { return objects[k].MovesAhead() && kept[k] == Side::kNone; });
  for (int c = 0; c < kCells; ++c) {
    const Cell& cell = cells_[reached - 1][static_cast<std::size_t>(c)];
    const double cost = static_cast<double>(cell.cost) +
                        (unfinished ? kUnfinished * std::abs(static_cast<double>(cell.lateral)) : 0.0);
    if (cost < best) {
      best = cost;
      l = c;
    }
  }
  for (std::size_t j = reached - 1; j > 0; --j) {
    const Cell& cell = cells_[j][static_cast<std::size_t>(l)];
    way.lateral[j] = static_cast<double>(cell.lateral);
    way.gap[j] = gaps_[j].gaps()[static_cast<std::size_t>(cell.gap)];
    for (const std::size_t k : Beside(stations, objects, speeds, j, {.leaves = terms.leaves})) {
      way.side[k] = way.lateral[j] > objects[k].LateralAt(0.5 * (speeds.t[j - 1] + speeds.t[j]))
                        ? Side::kLeft
                        : Side::kRight;
    }
    l = cell.from;
  }
  for (std::size_t k = 0; k < objects.size(); ++k) {
    if (kept[k] != Side::kNone && way.side[k] != Side::kNone && way.side[k] != kept[k])
      way.changes += kChange;
  }
}

}  // namespace control
