#include "tools/report/object_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"
#include "control/vehicle/obstacle_geometry.hpp"
#include "tools/report/rounded.hpp"

namespace tools {
namespace {

using control::Obstacle;
using Eigen::Vector2d;
using nlohmann::ordered_json;

// The arc lengths at which an object covers a part of the road, and half its length along the road there [m].
struct OnCourse {
  ordered_json s = ordered_json::array();
  double half_length = 0.0;
};

// A road with points of its course, to search it for objects. Where it crosses itself or is driven in laps, an object is
// on several parts of it.
class Course {
 public:
  explicit Course(const config::RouteFile& road) : road_(&road) {
    const auto steps = static_cast<int>(std::ceil(road.route.length() / kStride));
    for (int i = 0; i <= steps; ++i) points_.push_back(control::Position(road.route.At(i * kStride)));
  }

  [[nodiscard]] OnCourse Find(const Obstacle& object) const {
    OnCourse found;
    const Vector2d centre(object.X, object.Y);
    double before = std::numeric_limits<double>::infinity(), last = -before;
    double now = (points_.front() - centre).squaredNorm();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double next = i + 1 < points_.size() ? (points_[i + 1] - centre).squaredNorm()
                                                 : std::numeric_limits<double>::infinity();
      if (now <= before && now < next) {
        const control::RouteProjection place = road_->route.Project(centre, static_cast<double>(i) * kStride);
        if (place.s > last + kStride) Add(object, place, found);
        last = place.s;
      }
      before = now;
      now = next;
    }
    return found;
  }

 private:
  static constexpr double kStride = 2.0;  // [m]

  void Add(const Obstacle& object, const control::RouteProjection& place, OnCourse& found) const {
    const control::EnlargedObstacle outline(object);
    const double psi = road_->route.At(place.s).psi;
    const double half_width = outline.Support(control::LeftOf(psi));
    const control::RoadBounds edges = road_->road.At(place.s);
    if (place.lateral - half_width > edges.left || place.lateral + half_width < edges.right) return;
    found.s.push_back(Rounded(place.s, 1));
    found.half_length = outline.Support(control::Along(psi));
  }

  const config::RouteFile* road_;
  std::vector<Vector2d> points_;
};

// Noise and the bus's resolution do not count as motion.
bool Moved(const RecordedObject::Place& from, const RecordedObject::Place& to) {
  constexpr double kDistance = 0.05, kAngle = 0.01;  // [m], [rad]
  return std::hypot(to.X - from.X, to.Y - from.Y) > kDistance ||
         std::abs(std::remainder(to.heading - from.heading, 2.0 * M_PI)) > kAngle;
}

// Null if the object was not reported in the time of the samples.
ordered_json ObjectData(const RecordedObject& object, const DriveRecord& record, double margin,
                        const Course& course) {
  ordered_json k = ordered_json::array(), X = k, Y = k, heading = k, s = k, half_length = k;
  std::optional<RecordedObject::Place> last;
  std::size_t from = 0, to = 0;
  for (std::size_t i = 0; i < record.samples.size(); ++i) {
    const std::int64_t cycle = record.samples[i].cycle;
    if (!object.ExistsAt(cycle)) continue;
    if (!last) from = i;
    to = i;
    const RecordedObject::Place& place = object.At(cycle);
    if (last && !Moved(*last, place)) continue;
    last = place;
    Obstacle moved = object.first;
    moved.X = place.X;
    moved.Y = place.Y;
    moved.heading = place.heading;
    const OnCourse on_course = course.Find(moved);
    k.push_back(i);
    X.push_back(Rounded(place.X, 2));
    Y.push_back(Rounded(place.Y, 2));
    heading.push_back(Rounded(place.heading, 3));
    s.push_back(on_course.s);
    half_length.push_back(Rounded(on_course.half_length, 2));
  }
  if (!last) return nullptr;
  return {{"id", object.first.id},
          {"shape", object.first.shape == control::ObstacleShape::kBox ? "box" : "ellipse"},
          {"r_x", object.first.r_x},
          {"r_y", object.first.r_y},
          {"margin", margin},
          {"from", from},
          {"to", to},
          {"places",
           {{"k", std::move(k)},
            {"X", std::move(X)},
            {"Y", std::move(Y)},
            {"heading", std::move(heading)},
            {"s", std::move(s)},
            {"half_length", std::move(half_length)}}}};
}

}  // namespace

ordered_json ObjectsData(const DriveRecord& record, double margin, const config::RouteFile& road) {
  const Course course(road);
  ordered_json objects = ordered_json::array();
  for (const RecordedObject& object : record.objects) {
    ordered_json data = ObjectData(object, record, margin, course);
    if (!data.is_null()) objects.push_back(std::move(data));
  }
  return objects;
}

}  // namespace tools
