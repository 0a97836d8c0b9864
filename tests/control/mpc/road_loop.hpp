// LpvAffineMpc driving its own model along a road among obstacles, for tests.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "control/mpc/lpv_affine_mpc.hpp"
#include "control/road/keep_out.hpp"
#include "control/road/projection.hpp"
#include "control/road/road_profile.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "tests/control/roads.hpp"

namespace control::testing {

class RoadLoop {
 public:
  explicit RoadLoop(const Route& route, const LpvAffineSettings& settings = {}, const RoadEdges& edges = {})
      : settings_(settings),
        profile_(route, edges, {}),
        mpc_(VehicleParameters{}, profile_, settings),
        model_(BlendedModel(VehicleParameters{}), settings.t_s) {
    PlaceAt(0.0, profile_.At(0.0).speed);
  }
  RoadLoop(const RoadLoop&) = delete;  // the controller keeps a pointer to the road
  RoadLoop& operator=(const RoadLoop&) = delete;

  void PlaceAt(double s, double speed, double lateral = 0.0) {
    const RoutePoint point = profile_.At(s);
    const Eigen::Vector2d place = Beside(point, lateral);
    z_ << place.x(), place.y(), speed, 0.0, point.psi, 0.0;
    s_ = s;
  }
  // A circle of this radius at `s`, `lateral` [m] left of the road.
  [[nodiscard]] Obstacle ObstacleAt(double s, double lateral, double radius) const {
    const Eigen::Vector2d centre = Beside(profile_.At(s), lateral);
    return {.id = 1, .X = centre.x(), .Y = centre.y(), .r_x = radius, .r_y = radius};
  }

  State& z() { return z_; }
  Input& u() { return u_; }
  std::vector<Obstacle>& obstacles() { return obstacles_; }
  [[nodiscard]] const RoadProfile& profile() const { return profile_; }
  [[nodiscard]] const LpvAffineSettings& settings() const { return settings_; }
  LpvAffineMpc& mpc() { return mpc_; }
  [[nodiscard]] const DiscreteModel& model() const { return model_; }

  // From now on, `acts` disturbs the vehicle and the controller is told `told`.
  void Disturb(const Disturbance& acts, const Disturbance& told) {
    model_ = DiscreteModel(BlendedModel(VehicleParameters{}, acts), settings_.t_s);
    told_ = told;
  }
  // The controller's answer to the present state; nothing moves.
  const Plan& Ask() { return mpc_.Step(Asked()); }
  [[nodiscard]] ControllerInput Asked() const {
    return {.z = z_,
            .u_previous = u_,
            .place = {.s = s_},
            .obstacles = obstacles_,
            .disturbance = told_,
            .time_left = nullptr};
  }
  // Applies the plan's first input for one step; obstacles move on.
  void Drive(const Plan& plan) {
    u_ = plan.u[0];
    const double backwards = -z_[kUpsilon] / settings_.t_s;  // brakes cannot drive backwards [m/s²]
    z_ = model_.Step(z_, {u_[kDelta], std::max(u_[kAcceleration], backwards)});
    for (Obstacle& obstacle : obstacles_) obstacle = Predict(obstacle, settings_.t_s);
    const RouteProjection place = profile_.Project(z_.head<2>(), s_);
    s_ = place.s;
    lateral_ = place.lateral;
  }
  [[nodiscard]] double s() const { return s_; }
  [[nodiscard]] double lateral() const { return lateral_; }  // to the left of the road [m]

  // Points on the footprint's outline, in map coordinates.
  [[nodiscard]] std::vector<Eigen::Vector2d> Outline() const {
    constexpr int kPoints = 20;  // on each side
    const auto corners = settings_.footprint.Corners();
    const Eigen::Rotation2Dd turn(z_[kPsi]);
    std::vector<Eigen::Vector2d> points;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Eigen::Vector2d& to = corners[(k + 1) % corners.size()];
      for (int j = 0; j < kPoints; ++j) {
        const double share = static_cast<double>(j) / kPoints;
        points.emplace_back(z_.head<2>() + turn * ((1.0 - share) * corners[k] + share * to));
      }
    }
    return points;
  }
  // Least distance of the footprint from the obstacles, which are circles [m].
  [[nodiscard]] double Clearance() const {
    double least = 1e300;
    for (const Eigen::Vector2d& point : Outline()) {
      for (const Obstacle& o : obstacles_) {
        least = std::min(least, (point - Eigen::Vector2d(o.X, o.Y)).norm() - o.r_x);
      }
    }
    return least;
  }
  // Least distance of the footprint from the road's edges, negative off the road [m].
  [[nodiscard]] double RoadMargin() const {
    double least = 1e300;
    for (const Eigen::Vector2d& point : Outline()) {
      const RouteProjection place = profile_.Project(point, s_);
      const RoadBounds road = profile_.RoadAt(place.s);
      least = std::min({least, road.left - place.lateral, place.lateral - road.right});
    }
    return least;
  }

 private:
  LpvAffineSettings settings_;
  RoadProfile profile_;
  LpvAffineMpc mpc_;
  DiscreteModel model_;
  Disturbance told_;
  std::vector<Obstacle> obstacles_;
  State z_;
  Input u_ = Input::Zero();
  double s_ = 0.0;
  double lateral_ = 0.0;
};

// Largest difference between the inputs of two plans.
inline double LargestDifference(std::span<const Input> a, std::span<const Input> b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).cwiseAbs().maxCoeff());
  return largest;
}

// A drive on a winding road with obstacles on both sides.
struct BusyRoad : RoadLoop {
  explicit BusyRoad(const LpvAffineSettings& with = {}) : RoadLoop(WindingRoad(30.0, 12.0), with) {
    obstacles() = {ObstacleAt(60.0, 0.5, 0.7), ObstacleAt(110.0, -0.5, 0.7)};
    obstacles()[1].id = 2;
  }
};

}  // namespace control::testing
