// Tries to break the claim of docs/safety.md: whatever is planned, and whatever the others do within their bounds, the
// vehicle causes no contact and stays on the road.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <random>
#include <vector>

#include "control/vehicle/blended_model.hpp"
#include "control/vehicle/discrete_model.hpp"
#include "control/vehicle/geometry.hpp"
#include "control/vehicle/obstacle_geometry.hpp"
#include "loop/planner.hpp"

namespace loop {
namespace {

using namespace std::chrono_literals;
using control::Input;
using control::Obstacle;
using control::State;

constexpr double kPeriod = 0.05;
constexpr int kSteps = 30;
constexpr double kLaneWidth = 3.5;

double Uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// Plans anything: steering and acceleration are constant, or change once, and look at nothing.
class RecklessController final : public control::Controller {
 public:
  explicit RecklessController(std::mt19937& random) : random_(&random) {
    plan_.u.assign(kSteps, Input::Zero());
    plan_.z.assign(kSteps + 1, State::Zero());
  }
  int horizon() const override { return kSteps; }
  control::RouteProgress ProgressAt(const control::RoutePlace& place) const override {
    return control::ProgressByPlace(place);
  }
  const control::Plan& Step(const control::ControllerInput& input) override {
    plan_.status = control::SolverStatus::kSolved;
    const double back = -0.02 * input.z[control::kY] - 0.3 * input.z[control::kPsi];
    const double aim = Uniform(*random_, -0.02, 0.02);
    const double acceleration = Uniform(*random_, -2.0, 2.0);
    plan_.z[0] = input.z;
    for (int i = 0; i < kSteps; ++i) {
      const double share = static_cast<double>(i) / kSteps;
      plan_.u[control::Index(i)] = {std::clamp((1.0 - share) * aim + back, -0.05, 0.05), acceleration};
      plan_.z[control::Index(i) + 1] = model_.Step(plan_.z[control::Index(i)], plan_.u[control::Index(i)]);
    }
    return plan_;
  }
  void Reset() override {}

 private:
  std::mt19937* random_;
  control::DiscreteModel model_{control::BlendedModel(control::VehicleParameters{}), kPeriod};
  control::Plan plan_;
};

// An object that keeps its course and may brake.
struct Other {
  Obstacle obstacle;
  double brakes_at = 1e9;     // [s]
  double deceleration = 0.0;  // [m/s²]
  bool gives_way = false;     // comes towards the vehicle

  void Move(double t, bool for_vehicle) {
    const double speed = std::hypot(obstacle.velocity_X, obstacle.velocity_Y);
    if (speed < 1e-6) return;
    const double a = for_vehicle ? std::max(deceleration, 3.0) : (t >= brakes_at ? deceleration : 0.0);
    const double next = std::max(speed - a * kPeriod, 0.0);
    const double way = 0.5 * (speed + next) * kPeriod;
    obstacle.X += way * obstacle.velocity_X / speed;
    obstacle.Y += way * obstacle.velocity_Y / speed;
    obstacle.velocity_X *= next / speed;
    obstacle.velocity_Y *= next / speed;
  }
};

class VerifiedStopTest : public testing::Test {
 protected:
  Other Draw(int id) {
    Other other{.obstacle = {.id = id,
                             .r_x = 2.25,
                             .r_y = 0.9,
                             .shape = control::ObstacleShape::kBox,
                             .object_class = control::ObstacleClass::kVehicle}};
    Obstacle& o = other.obstacle;
    other.brakes_at = Uniform(random_, 0.0, 12.0);
    other.deceleration = Uniform(random_, 0.0, 8.0);
    switch (std::uniform_int_distribution<int>(0, 3)(random_)) {
      case 0:  // stands
        o.X = Uniform(random_, 40.0, 150.0);
        o.Y = Uniform(random_, -1.5, 5.0);
        break;
      case 1:  // ahead
        o.X = Uniform(random_, 30.0, 100.0);
        o.velocity_X = Uniform(random_, 3.0, 15.0);
        break;
      case 2:  // comes towards the vehicle in the other lane
        o.X = Uniform(random_, 100.0, 300.0);
        o.Y = kLaneWidth;
        o.heading = M_PI;
        o.velocity_X = -Uniform(random_, 5.0, 15.0);
        other.gives_way = true;
        break;
      default:  // crosses
        o.X = Uniform(random_, 40.0, 120.0);
        o.Y = Uniform(random_, -15.0, -3.0);
        o.heading = M_PI / 2.0;
        o.r_x = o.r_y = 0.4;
        o.velocity_Y = Uniform(random_, 1.0, 4.0);
        o.object_class = control::ObstacleClass::kPedestrian;
        break;
    }
    return other;
  }

  std::mt19937 random_;
  const std::vector<control::RoutePiece> straight_{{.length = 400.0}};
  const control::RoadProfile profile_{
      control::Route::FromPieces({}, 15.0, straight_), control::RoadBounds{.left = 5.25, .right = -1.75}, {}};
  const control::TimeReference reference_{
      control::SampleRoute(control::Route::FromPieces({}, 15.0, straight_), kPeriod), kPeriod};
  const control::Footprint footprint_{.front = 1.95, .rear = 2.3, .half_width = 0.9};
};

TEST_F(VerifiedStopTest, RecklessPlansCauseNoContactAndLeaveNoRoad) {
  constexpr int kDrives = 300;
  int driven = 0, stops = 0, refused = 0;
  for (int drive = 0; drive < kDrives; ++drive) {
    random_.seed(static_cast<unsigned>(drive));
    RecklessController controller(random_);
    control::PlanCheck check({.vehicle = {}, .footprint = footprint_, .mu = 0.8, .t_s = kPeriod}, profile_);
    Planner planner(
        {.period = 50ms, .deadline = 50ms, .vehicle = {}, .mu = 0.8}, controller, profile_,
        [] { return base::Time{}; }, &check);
    control::Odometer odometer({}, kPeriod, reference_);
    const control::DiscreteModel model(control::BlendedModel(control::VehicleParameters{}), kPeriod);

    std::vector<Other> others;
    for (int id = std::uniform_int_distribution<int>(1, 4)(random_); id > 0; --id) others.push_back(Draw(id));
    State z = State::Zero();
    z[control::kX] = 10.0;
    z[control::kUpsilon] = Uniform(random_, 5.0, 20.0);
    odometer.Start(z, 0);
    Input applied = Input::Zero();
    bool commanding = false;
    double stopping = 0.0;  // time since the stop began [s]
    for (int step = 0; step < 300 && z[control::kX] < 330.0; ++step) {
      std::vector<Obstacle> seen;
      for (const Other& other : others) seen.push_back(other.obstacle);
      Snapshot known;
      known.now = known.state.timestamp = step * 50ms;
      known.step = step;
      known.state_new = known.state_fresh = known.obstacles_fresh = true;
      known.state.z = z;
      known.obstacles = seen;
      odometer.Advance(&z, applied);
      const control::RoutePlace place{.on_route = true,
                                      .nearest = odometer.motion().nearest,
                                      .s = z[control::kX],
                                      .samples = reference_.size()};
      const Outcome outcome = planner.Plan(commanding ? PlanRequest::kNext : PlanRequest::kFirst, known,
                                           place, commanding, applied);
      if (!commanding && (!outcome.accepted || outcome.rejection)) break;  // the driver drives on
      commanding = true;
      refused += outcome.accepted ? 0 : 1;
      const bool stop =
          !outcome.accepted && (outcome.stop_due || stopping > 0.0 || !planner.active().Covers(step));
      stopping = stop ? stopping + kPeriod : 0.0;
      stops += stop ? 1 : 0;
      applied =
          stop ? planner.StopInput(known, place, odometer.motion(), applied) : planner.active().At(step);
      z = model.Step(z, applied);
      z[control::kUpsilon] = std::max(z[control::kUpsilon], 0.0);
      for (Other& other : others) {
        const bool in_its_way = std::abs(z[control::kY] - other.obstacle.Y) < 1.8 + 0.3;
        other.Move(step * kPeriod, other.gives_way && stopping > 1.0 && in_its_way);
      }
      if (z[control::kUpsilon] < 0.1) continue;
      for (const Other& other : others) {
        if (other.obstacle.X < z[control::kX] - 2.3) continue;  // it runs into the vehicle from behind
        ASSERT_LT(Overlap(other.obstacle, footprint_, z), 0.05)
            << "drive " << drive << ", step " << step << ", object " << other.obstacle.id << " at "
            << other.obstacle.X << ", " << other.obstacle.Y << ", vehicle " << z.transpose();
      }
      for (const Eigen::Vector2d& corner : footprint_.Corners()) {
        const double y = (control::Position(z) + control::Rotate(z[control::kPsi], corner)).y();
        ASSERT_LT(std::max(y - 5.25, -1.75 - y), 0.15) << "drive " << drive << ", step " << step;
      }
    }
    driven += commanding ? 1 : 0;
  }
  EXPECT_GT(driven, kDrives / 3);
  EXPECT_GT(stops, 100);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace loop
