#include "sim/free_way.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "control/vehicle/geometry.hpp"

namespace sim {
namespace {

using Eigen::Vector2d;

constexpr double kLookahead = 15.0;                                   // [m]
constexpr double kRadius = 6.0;                                       // of the turning circle [m]
constexpr double kForesight = 4.0;                                    // [s]
constexpr double kMargin = 0.3;                                       // on either side [m]
constexpr std::array<double, 5> kStraights{0.0, 2.0, 4.0, 6.0, 8.0};  // before the shift [m]
constexpr std::array<double, 5> kMiddles{0.0, 1.0, 2.0, 3.0, 4.0};    // within it [m]
constexpr double kHeadingStep = std::numbers::pi / 36.0;              // [rad]
constexpr double kSteepest = std::numbers::pi / 3.0;                  // [rad]
constexpr double kStep = 0.5;                                         // between two poses [m]

// What an object covers of the road, by arc length and offset.
struct Box {
  Vector2d low;
  Vector2d high;
};

struct Pose {
  Vector2d position;  // arc length and offset of the rear axle
  double heading = 0.0;
};

Box SweptBy(const RoadBody& object) {
  const Vector2d way = kForesight * Vector2d(object.speed, object.lateral_speed);
  return {.low = Vector2d(object.rear, object.right) + way.cwiseMin(0.0),
          .high = Vector2d(object.front, object.left) + way.cwiseMax(0.0)};
}

class Way {
 public:
  Way(const RoadBody& vehicle, const control::Footprint& footprint, double l_r,
      std::span<const RoadBody> objects, const control::RoadEdges& edges)
      : start_{.position = Vector2d(vehicle.s, vehicle.lateral) - l_r * control::Along(vehicle.heading),
               .heading = vehicle.heading},
        from_axle_{
            .front = footprint.front + l_r, .rear = footprint.rear - l_r, .half_width = footprint.half_width},
        edges_(&edges) {
    for (const RoadBody& object : objects) {
      const bool follows = object.s < vehicle.rear && InSameLane(object, vehicle);
      if (!follows) boxes_.push_back(SweptBy(object));
    }
  }

  // Along the path that goes straight for `straight` [m], turns to `peak` [rad] and keeps that for `middle` [m].
  [[nodiscard]] bool IsFree(double straight, double peak, double middle) const {
    Pose pose = start_;
    const auto go = [&](double length, double turn, double margin) {  // until it is not free, or far enough
      const int steps = static_cast<int>(std::ceil(length / kStep));
      for (int i = 0; i < steps && !FarEnough(pose); ++i) {
        if (!IsClear(pose, margin)) return false;
        pose.position += length / steps * control::Along(pose.heading + 0.5 * turn / steps);
        pose.heading += turn / steps;
      }
      return true;
    };
    const double out = peak - start_.heading;
    return go(straight, 0.0, 0.0) && go(kRadius * std::abs(out), out, 0.0) && go(middle, 0.0, 0.0) &&
           go(kRadius * std::abs(peak), -peak, 0.0) && go(kLookahead, 0.0, kMargin) && IsClear(pose, kMargin);
  }

  [[nodiscard]] bool IsFree() const {
    const int steps = static_cast<int>(2.0 * kSteepest / kHeadingStep);
    for (int i = -steps; i <= steps; ++i) {
      const double peak = start_.heading + i * kHeadingStep;
      if (std::abs(peak) > kSteepest) continue;
      for (const double straight : kStraights) {
        for (const double middle : kMiddles) {
          if (IsFree(straight, peak, middle)) return true;
        }
      }
    }
    return false;
  }

 private:
  [[nodiscard]] bool FarEnough(const Pose& pose) const {
    return pose.position.x() >= start_.position.x() + kLookahead;
  }

  [[nodiscard]] bool IsClear(const Pose& pose, double margin) const {
    control::Footprint wide = from_axle_;
    wide.half_width += margin;
    std::array<Vector2d, 4> corners = wide.Corners();
    for (Vector2d& corner : corners) corner = pose.position + control::Rotate(pose.heading, corner);
    for (const Vector2d& corner : corners) {
      const control::RoadBounds road = edges_->At(corner.x());
      if (corner.y() > road.left || corner.y() < road.right) return false;
    }
    return std::ranges::none_of(boxes_,
                                [&](const Box& box) { return Overlap(box, corners, pose.heading, wide); });
  }

  // Two convex shapes are apart if they are along the normal of one of their edges.
  [[nodiscard]] static bool Overlap(const Box& box, const std::array<Vector2d, 4>& corners, double heading,
                                    const control::Footprint& wide) {
    Vector2d low = corners[0], high = corners[0];
    for (const Vector2d& corner : corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    if ((low.array() >= box.high.array()).any() || (high.array() <= box.low.array()).any()) return false;
    const Vector2d centre = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
    const auto apart = [&](const Vector2d& axis, double length) {  // from corners[2], the rear right one
      const double middle = axis.dot(centre - corners[2]), reach = axis.cwiseAbs().dot(half);
      return middle - reach >= length || middle + reach <= 0.0;
    };
    return !apart(control::Along(heading), wide.front + wide.rear) &&
           !apart(control::LeftOf(heading), 2.0 * wide.half_width);
  }

  Pose start_;
  control::Footprint from_axle_;  // the vehicle's rectangle about the rear axle
  const control::RoadEdges* edges_;
  std::vector<Box> boxes_;
};

}  // namespace

bool WayIsFree(const RoadBody& vehicle, const control::Footprint& footprint, double l_r,
               std::span<const RoadBody> objects, const control::RoadEdges& edges) {
  return Way(vehicle, footprint, l_r, objects, edges).IsFree();
}

}  // namespace sim
