#include "tools/sweep/encounter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tools {
namespace {

control::Obstacle At(const control::Obstacle& obstacle, double time) {
  control::Obstacle moved = obstacle;
  moved.X += time * obstacle.velocity_X;
  moved.Y += time * obstacle.velocity_Y;
  return moved;
}

// Half the length of the ellipse's shadow on a line at `angle` [rad] to its first axis.
double HalfShadow(const control::Obstacle& obstacle, double angle) {
  return std::hypot(obstacle.r_x * std::cos(angle), obstacle.r_y * std::sin(angle));
}

std::optional<double> MeetingTime(const sim::Scenario& scenario, const control::Obstacle& obstacle) {
  const double speed = scenario.route.At(0.0).speed;
  const auto ahead = [&](double time) {
    const control::Obstacle there = At(obstacle, time);
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
    Encounter encounter{.obstacle = At(obstacle, *time), .time = *time};
    const auto appears = scenario.appears_at.find(obstacle.id);
    if (appears != scenario.appears_at.end()) encounter.perceived_at = appears->second;
    const control::RouteProjection place =
        scenario.route.Project({encounter.obstacle.X, encounter.obstacle.Y});
    encounter.s = place.s;
    encounter.lateral = place.lateral;
    const double psi = scenario.route.At(place.s).psi;
    encounter.half_length = HalfShadow(obstacle, obstacle.heading - psi);
    encounter.half_width = HalfShadow(obstacle, obstacle.heading - psi - M_PI_2);
    encounter.velocity_along = obstacle.velocity_X * std::cos(psi) + obstacle.velocity_Y * std::sin(psi);
    encounters.push_back(encounter);
  }
  std::ranges::sort(encounters, {}, &Encounter::time);
  return encounters;
}

}  // namespace tools
