#include "tools/scenarios/encounter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "control/road/keep_out.hpp"
#include "control/vehicle/geometry.hpp"

namespace tools {
namespace {

std::optional<double> MeetingTime(const sim::Scenario& scenario, const control::Obstacle& obstacle) {
  const double speed = scenario.route.At(0.0).speed;
  const auto ahead = [&](double time) {
    const control::Obstacle there = control::Predict(obstacle, time);
    return scenario.route.Project({there.X, there.Y}).s - speed * time;
  };
  double before = 0.0, after = scenario.route.duration();
  if (ahead(before) < 0.0 || ahead(after) > 0.0) return std::nullopt;
  while (after - before > 1e-6) {
    const double middle = 0.5 * (before + after);
    (ahead(middle) > 0.0 ? before : after) = middle;
  }
  return after;
}

}  // namespace

std::vector<Encounter> Encounters(const sim::Scenario& scenario) {
  std::vector<Encounter> encounters;
  for (const control::Obstacle& obstacle : scenario.obstacles) {
    const std::optional<double> time = MeetingTime(scenario, obstacle);
    if (!time) continue;
    Encounter encounter{.obstacle = control::Predict(obstacle, *time), .time = *time};
    const auto appears = scenario.appears_at.find(obstacle.id);
    if (appears != scenario.appears_at.end()) encounter.perceived_at = appears->second;
    const control::RouteProjection place =
        scenario.route.Project({encounter.obstacle.X, encounter.obstacle.Y});
    encounter.s = place.s;
    encounter.lateral = place.lateral;
    const double psi = scenario.route.At(place.s).psi;
    const Eigen::Vector2d along = control::Along(psi);
    encounter.half_length = control::SupportOf(obstacle, along);
    encounter.half_width = control::SupportOf(obstacle, control::LeftOf(psi));
    encounter.velocity_along = along.dot(Eigen::Vector2d(obstacle.velocity_X, obstacle.velocity_Y));
    encounters.push_back(encounter);
  }
  std::ranges::sort(encounters, {}, &Encounter::time);
  return encounters;
}

}  // namespace tools
