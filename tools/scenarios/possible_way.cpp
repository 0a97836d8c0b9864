#include "tools/scenarios/possible_way.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "tools/scenarios/encounter.hpp"

namespace tools {
namespace {

using control::PassingSide;

constexpr double kFrictionShare = 0.7;
constexpr double kBeside = 0.2;  // free space on either side of the vehicle [m]

// Lateral positions of a gap's ends, left positive [m].
struct Gap {
  double right;
  double left;
};

double HighestCurvature(const control::Route& route, double from, double to) {
  constexpr double kSpacing = 1.0;  // [m]
  double highest = std::abs(route.At(to).curvature);
  for (double s = from; s < to; s += kSpacing) {
    highest = std::max(highest, std::abs(route.At(s).curvature));
  }
  return highest;
}

bool OnPrescribedSide(const Encounter& met, const Gap& gap) {
  switch (met.obstacle.side) {
    case PassingSide::kLeft:
      return gap.right >= met.lateral + met.half_width;
    case PassingSide::kRight:
      return gap.left <= met.lateral - met.half_width;
    case PassingSide::kUnknown:
      break;
  }
  return true;
}

// The obstacles that the vehicle is beside at the same time as `met`, including `met`.
std::vector<Encounter> MetTogether(const std::vector<Encounter>& all, const Encounter& met,
                                   const control::Footprint& footprint) {
  std::vector<Encounter> beside;
  for (const Encounter& other : all) {
    const double apart = std::abs(other.s - met.s);
    if (apart <= met.half_length + other.half_length + footprint.front + footprint.rear)
      beside.push_back(other);
  }
  std::ranges::sort(beside, {}, [](const Encounter& other) { return other.lateral - other.half_width; });
  return beside;
}

// The least shift from the road's middle that leads past `met`; none if no gap is wide enough on the prescribed side.
std::optional<double> LeastShift(const std::vector<Encounter>& all, const Encounter& met,
                                 const sim::Scenario& scenario) {
  const std::vector<Encounter> beside = MetTogether(all, met, scenario.footprint);
  std::vector<Gap> gaps;
  const control::RoadBounds road = scenario.road.At(met.s);
  double right = road.right;
  for (const Encounter& other : beside) {
    gaps.push_back({.right = right, .left = other.lateral - other.half_width});
    right = std::max(right, other.lateral + other.half_width);
  }
  gaps.push_back({.right = right, .left = road.left});

  const double margin = scenario.footprint.half_width + kBeside;
  std::optional<double> least;
  for (const Gap& gap : gaps) {
    const bool allowed =
        std::ranges::all_of(beside, [&](const Encounter& other) { return OnPrescribedSide(other, gap); });
    if (!allowed || gap.left - gap.right < 2.0 * margin) continue;
    const double shift = std::max({0.0, gap.right + margin, -(gap.left - margin)});
    least = std::min(least.value_or(shift), shift);
  }
  return least;
}

PossibleWay WayPast(const std::vector<Encounter>& all, const Encounter& met, const sim::Scenario& scenario) {
  const double speed = scenario.route.At(0.0).speed;
  const double perceived_s = speed * met.perceived_at;
  const double a = kFrictionShare * scenario.plant.mu * sim::kGravity -
                   speed * speed * HighestCurvature(scenario.route, perceived_s, met.s);
  if (a <= 0.0) return PossibleWay::kNone;
  const std::optional<double> shift = LeastShift(all, met, scenario);
  if (shift && met.time - met.perceived_at >= 2.0 * std::sqrt(*shift / a)) return PossibleWay::kPass;
  const double room = met.s - perceived_s - met.half_length - scenario.footprint.front;
  const bool comes = met.velocity_along < 0.0;
  return !comes && speed * speed / (2.0 * a) <= room ? PossibleWay::kStop : PossibleWay::kNone;
}

}  // namespace

PossibleWay FindPossibleWay(const sim::Scenario& scenario) {
  const std::vector<Encounter> encounters = Encounters(scenario);
  for (const Encounter& met : encounters) {
    const PossibleWay way = WayPast(encounters, met, scenario);
    if (way != PossibleWay::kPass) return way;
  }
  return PossibleWay::kPass;
}

const char* NameOf(PossibleWay way) {
  switch (way) {
    case PossibleWay::kPass:
      return "pass";
    case PossibleWay::kStop:
      return "stop";
    case PossibleWay::kNone:
      break;
  }
  return "none";
}

}  // namespace tools
