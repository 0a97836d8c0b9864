#include "control/traffic/road_objects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/road/projection.hpp"

namespace control {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBehind = 60.0;     // objects further behind do not catch up within the horizon [m]
constexpr double kFarthest = 800.0;  // length of road on which objects are searched for [m]
constexpr double kBeside = 0.5;      // objects nearer to the road than this count as on it [m]
constexpr double kFaster = 0.5;      // [m/s]
constexpr double kSamePlace = 1.0;   // places nearer to one another than this are the same [m]

}  // namespace

RoadObjects::RoadObjects(const Footprint& footprint, double time, const RoadProfile& profile)
    : footprint_(footprint), time_(time), profile_(&profile) {
  course_.reserve(static_cast<std::size_t>((kFarthest + kBehind) / kStride) + 2);
  objects_.reserve(kMost + 1);
}

void RoadObjects::Select(std::span<const Obstacle> obstacles, const RoadPosition& vehicle, double distance) {
  objects_.clear();
  left_out_ = 0;
  if (obstacles.empty()) return;
  double reach = 0.0;
  for (const Obstacle& obstacle : obstacles) reach = std::max(reach, HowFar(obstacle));
  SampleCourse(vehicle.s - kBehind, vehicle.s + std::min(distance + footprint_.front + reach, kFarthest));
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const double far = profile_->edges().Widest() + kBeside + HowFar(obstacles[k]) + kStride;
    const Eigen::Vector2d centre(obstacles[k].X, obstacles[k].Y);
    const auto squared = [&](std::size_t j) {
      return j < course_.size() ? (course_[j] - centre).squaredNorm() : kInfinity;
    };
    double last_added = -kInfinity;
    for (std::size_t j = 0; j < course_.size(); ++j) {
      const double now = squared(j);
      if (now > far * far) {
        // Nor is it beside the next points, as far as they are nearer to this one than the object is.
        j += static_cast<std::size_t>((std::sqrt(now) - far) / kStride);
        continue;
      }
      if (now >= squared(j + 1) || (j > 0 && now > squared(j - 1))) continue;
      const double hint = course_from_ + static_cast<double>(j) * kStride;
      const RoadObject object = PlaceOnRoad(obstacles[k], k, *profile_, hint);
      if (object.s > last_added + kSamePlace) Add(object, vehicle, distance);
      last_added = std::max(last_added, object.s);
    }
  }
}

// The distance from its centre within which the object can be within the horizon [m].
double RoadObjects::HowFar(const Obstacle& obstacle) const {
  return std::hypot(obstacle.velocity_X, obstacle.velocity_Y) * time_ + obstacle.r_x + obstacle.r_y;
}

void RoadObjects::SampleCourse(double from, double to) {
  course_.clear();
  course_from_ = from;
  for (double s = from; s < to + kStride && course_.size() < course_.capacity(); s += kStride) {
    course_.push_back(Position(profile_->At(s)));
  }
}

// Keeps the objects sorted by their near ends; if there are too many, drops the farthest.
void RoadObjects::Add(const RoadObject& object, const RoadPosition& vehicle, double distance) {
  if (!Matters(object, vehicle, distance)) return;
  const auto near_end = [](const RoadObject& o) { return o.s - o.half_length; };
  objects_.insert(std::ranges::upper_bound(objects_, near_end(object), {}, near_end), object);
  if (objects_.size() > kMost) {
    objects_.pop_back();
    ++left_out_;
  }
}

bool RoadObjects::Matters(const RoadObject& object, const RoadPosition& vehicle, double distance) const {
  const RoadBounds road = profile_->RoadAt(object.s);
  const double last = object.LateralAt(time_);
  const double rightmost = std::min(object.lateral, last) - object.half_width;
  const double leftmost = std::max(object.lateral, last) + object.half_width;
  if (rightmost > road.left + kBeside || leftmost < road.right - kBeside) return false;
  const double rear = vehicle.s - footprint_.rear, front = vehicle.s + footprint_.front;
  const double near = object.s - object.half_length, far = object.s + object.half_length;
  if (near + std::min(object.speed, 0.0) * time_ > front + distance) return false;
  if (far >= rear) return true;
  // Behind: what follows in the vehicle's lane keeps its own distance; what overtakes in another lane matters.
  const bool same_lane =
      std::abs(object.lateral - vehicle.lateral) < object.half_width + footprint_.half_width;
  return !same_lane && object.speed > vehicle.speed + kFaster && far + object.speed * time_ > rear;
}

}  // namespace control
