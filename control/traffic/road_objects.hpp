// The objects that matter to the vehicle in the next seconds, in road coordinates. Objects do not matter if they are off
// the road and stay there, if they have been passed and are no faster, if they follow in the vehicle's own lane, or if
// they are beyond the horizon. Of an object beside two parts of the course (a crossing, an out-and-back road) there is
// one road object for each part.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "control/road/road_profile.hpp"
#include "control/traffic/road_object.hpp"
#include "control/vehicle/footprint.hpp"
#include "control/vehicle/types.hpp"

namespace control {

// The vehicle in road coordinates.
struct RoadPosition {
  double s = 0.0;        // arc length [m]
  double lateral = 0.0;  // left positive [m]
  double slope = 0.0;    // change of `lateral` per metre of road
  double speed = 0.0;    // [m/s]
};

class RoadObjects {
 public:
  static constexpr std::size_t kMost = 32;
  static constexpr double kStride = 2.0;  // spacing of the search for places beside an object [m]

  // `profile` must outlive this object. Objects count as far as they can be met within `time` [s].
  RoadObjects(const Footprint& footprint, double time, const RoadProfile& profile);

  // Selects the objects that matter to a vehicle that covers at most `distance` [m] of the road within the horizon.
  // Does not allocate.
  void Select(std::span<const Obstacle> obstacles, const RoadPosition& vehicle, double distance);
  // The vehicle yields to object k. Holds until the next selection.
  void YieldTo(std::size_t k) { objects_[k].yielded_to = true; }

  // By increasing distance along the road; valid until the next call.
  [[nodiscard]] std::span<const RoadObject> objects() const { return objects_; }
  // Number of objects that matter, but for which there was no room. They are the farthest ones.
  [[nodiscard]] std::size_t left_out() const { return left_out_; }

 private:
  [[nodiscard]] double HowFar(const Obstacle& obstacle) const;
  void SampleCourse(double from, double to);
  void Add(const RoadObject& object, const RoadPosition& vehicle, double distance);
  [[nodiscard]] bool Matters(const RoadObject& object, const RoadPosition& vehicle, double distance) const;

  Footprint footprint_;
  double time_;
  const RoadProfile* profile_;
  std::vector<Eigen::Vector2d> course_;  // points of the road from course_from_ on, kStride apart
  double course_from_ = 0.0;
  std::vector<RoadObject> objects_;
  std::size_t left_out_ = 0;
};

}  // namespace control
