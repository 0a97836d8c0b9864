#include "tools/bench/roadside_posts.hpp"

#include <algorithm>
#include <cmath>

#include "control/road/projection.hpp"

namespace tools {
namespace {

constexpr int kIds = 64;           // on the bus
constexpr double kSpacing = 1.25;  // of the posts along the route [m]
constexpr double kRadius = 0.1;    // [m]
constexpr double kBeyond = 0.3;    // the edge [m]
constexpr double kTail = 60.0;     // way beyond the route's end that is lined, too [m]
constexpr double kRear = 2.0;      // behind the vehicle's centre, where a post has not been passed yet [m]

control::RoutePoint PointAt(const control::Route& route, double s) {
  return s <= route.length() ? route.At(s)
                             : control::StraightAhead(route.At(route.length()), s - route.length());
}

// True if a thing at this position would stand on the road anywhere along the route.
bool IsOnRoad(const Eigen::Vector2d& position, const config::RouteFile& file) {
  constexpr double kStep = 1.0;  // [m]
  for (double s = 0.0; s < file.route.length(); s += kStep) {
    const control::RoutePoint point = file.route.At(s);
    const auto [ahead, left] = control::OffsetFrom({point.X, point.Y}, point.psi, position);
    const control::RoadBounds edges = file.road.At(s);
    const double apart = 0.5 * kBeyond;
    if (std::abs(ahead) <= kStep && left < edges.left + apart && left > edges.right - apart) return true;
  }
  return false;
}

}  // namespace

RoadsidePosts::RoadsidePosts(const sim::Scenario& scenario, const config::RouteFile& route)
    : route_(route.route) {
  std::vector<int> free;
  for (int id = 0; id < kIds; ++id) {
    if (std::ranges::find(scenario.obstacles, id, &control::Obstacle::id) == scenario.obstacles.end())
      free.push_back(id);
  }
  ids_ = free.size();
  if (free.empty()) return;
  bool left = true;
  for (double s = 0.0; s < route_.length() + kTail; s += kSpacing, left = !left) {
    const control::RoadBounds edges = route.road.At(s);
    const double offset = left ? edges.left + kBeyond + kRadius : edges.right - kBeyond - kRadius;
    const Eigen::Vector2d centre = control::Beside(PointAt(route_, s), offset);
    if (IsOnRoad(centre, route)) continue;
    posts_.push_back({.s = s,
                      .obstacle = {.id = free[posts_.size() % free.size()],
                                   .X = centre.x(),
                                   .Y = centre.y(),
                                   .r_x = kRadius,
                                   .r_y = kRadius,
                                   .object_class = control::ObstacleClass::kStatic}});
  }
}

std::vector<control::Obstacle> RoadsidePosts::Ahead(const Eigen::Vector2d& position, std::size_t count) {
  hint_ = route_.Project(position, hint_).s;
  std::vector<control::Obstacle> ahead;
  for (auto post = std::ranges::lower_bound(posts_, *hint_ - kRear, {}, &Post::s);
       post != posts_.end() && ahead.size() < std::min(count, ids_); ++post) {
    ahead.push_back(post->obstacle);
  }
  return ahead;
}

}  // namespace tools
