// The daemon and the simulated vehicle in traffic on a real interface: scenarios of the catalogue, judged by nothing but
// the frames that a third party hears.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bus/vehicle_bus.hpp"
#include "can/socket.hpp"
#include "loop/obstacle_assembler.hpp"
#include "sim/footprint_distance.hpp"
#include "tests/support/process.hpp"
#include "tests/support/temp_dir.hpp"

namespace {

using namespace std::chrono_literals;
using bus::ManoeuvreDecision;
using bus::ManoeuvreReason;
using bus::Mode;

constexpr const char* kInterface = "vcan0";
constexpr control::Footprint kVehicle{.front = 2.22, .rear = 2.48, .half_width = 0.92};  // of the scenarios

// What was heard of a control cycle: the state and the objects, and what was answered.
struct Cycle {
  bus::VehiclePose pose;
  bus::VehicleMotion motion;
  bus::VehicleFeedback feedback;
  std::vector<control::Obstacle> objects;
  bus::SteeringCommand steering;
  bus::AccelerationCommand acceleration;
  bus::ControllerStatus status;
  bus::ManoeuvreStatus manoeuvre;

  [[nodiscard]] const control::Obstacle* Object(int id) const {
    const auto found = std::ranges::find(objects, id, &control::Obstacle::id);
    return found == objects.end() ? nullptr : &*found;
  }
  [[nodiscard]] bool Decides(ManoeuvreDecision decision, int object) const {
    return manoeuvre.decision == decision && manoeuvre.object_id == object;
  }
  // The roads of these scenarios lead along X. Negative: they overlap.
  [[nodiscard]] double GapAhead(const control::Obstacle& object) const {
    return object.X - object.r_x - (pose.X + kVehicle.front);
  }
  [[nodiscard]] double GapBehind(const control::Obstacle& object) const {
    return pose.X - kVehicle.rear - (object.X + object.r_x);
  }
};

class TrafficOnVcan : public testing::Test {
 protected:
  // Drives the scenario until `done` holds for a cycle; it fails if the drive ends before. The cycles from engagement
  // on, that one included, are in `cycles_`.
  void DriveUntil(const std::string& name, const std::function<bool(const Cycle&)>& done,
                  bool lockstep = true) {
    const std::filesystem::path scenario =
        std::filesystem::path(LPVMPC_SOURCE_DIR "/scenarios/catalogue") / name;
    std::vector<std::string> daemon_command{LPVMPCD, "--config", (scenario / "lpvmpcd.toml").string(),
                                            "--interface", kInterface};
    std::vector<std::string> vehicle_command{LPVMPC_SIM, "--interface", kInterface, "--scenario",
                                             (scenario / "scenario.toml").string()};
    if (lockstep) {
      daemon_command.emplace_back("--lockstep");
      vehicle_command.emplace_back("--lockstep");
    }
    const test_support::Process daemon(daemon_command);
    test_support::Process vehicle(vehicle_command);
    bool ended = false;  // what the vehicle sent before its end is still read
    while (!done_ && !ended) {
      ended = !vehicle.Running();
      static_cast<void>(can::WaitReadable(socket_.fd(), 20ms));
      for (can::Received received; !done_ && socket_.Receive(received) == can::ReceiveStatus::kFrame;) {
        Take(received.frame, done);
      }
    }
    EXPECT_EQ(socket_.dropped(), 0U);
    EXPECT_TRUE(done_) << vehicle.Stdout() << vehicle.Stderr() << daemon.Stderr();
    ASSERT_FALSE(cycles_.empty());
  }

  // What must hold in each cycle of each drive.
  void ExpectActiveAndApart() const {
    for (const Cycle& cycle : cycles_) {
      ASSERT_EQ(cycle.status.mode, Mode::kActive) << "X = " << cycle.pose.X;
      ASSERT_TRUE(cycle.steering.enable && cycle.acceleration.enable) << "X = " << cycle.pose.X;
      for (const control::Obstacle& object : cycle.objects) {
        ASSERT_GT(sim::FootprintDistance(object, kVehicle, {cycle.pose.X, cycle.pose.Y}, cycle.feedback.psi),
                  0.0)
            << "object " << object.id << ", X = " << cycle.pose.X;
      }
    }
  }

  // The first cycle for which `condition` holds, from `begin` on.
  template <typename Condition>
  [[nodiscard]] std::vector<Cycle>::const_iterator First(
      const Condition& condition, std::optional<std::vector<Cycle>::const_iterator> begin = {}) const {
    return std::find_if(begin.value_or(cycles_.begin()), cycles_.end(), condition);
  }

  std::vector<Cycle> cycles_;

 private:
  void Take(const can::Frame& frame, const std::function<bool(const Cycle&)>& done) {
    const auto message = bus_.Decode(frame.id, frame.Payload());
    ASSERT_TRUE(message) << "a frame of another sender: " << frame.id;
    ASSERT_EQ(bus_.Check(frame.id, frame.Payload()).verdict, bus::E2eVerdict::kOk);
    std::visit([this](const auto& typed) { Hear(typed); }, *message);
    // The manoeuvre is the last frame of a cycle.
    if (!std::holds_alternative<bus::ManoeuvreStatus>(*message)) return;
    if (cycles_.empty() && heard_.status.mode != Mode::kActive) return;
    cycles_.push_back(heard_);
    done_ = done(heard_);
  }

  void Hear(const bus::VehiclePose& pose) { heard_.pose = pose; }
  void Hear(const bus::VehicleMotion& motion) { heard_.motion = motion; }
  void Hear(const bus::VehicleFeedback& feedback) { heard_.feedback = feedback; }
  void Hear(const bus::SteeringCommand& steering) { heard_.steering = steering; }
  void Hear(const bus::AccelerationCommand& acceleration) { heard_.acceleration = acceleration; }
  void Hear(const bus::ControllerStatus& status) { heard_.status = status; }
  void Hear(const bus::ManoeuvreStatus& manoeuvre) { heard_.manoeuvre = manoeuvre; }
  void Hear(const bus::ObstaclePosition& position) { objects_.Update(position); }
  void Hear(const bus::ObstacleShape& shape) { objects_.Update(shape); }
  void Hear(const bus::ObstacleMotion& motion) { objects_.Update(motion); }
  void Hear(const bus::ObstacleList& list) {
    ASSERT_TRUE(objects_.Update(list, {}));
    heard_.objects.assign(objects_.obstacles().begin(), objects_.obstacles().end());
  }
  template <typename Other>
  void Hear(const Other& /*told*/) {}

  bus::VehicleBus bus_;
  // In lock step the frames come as fast as they can be made, and this test may have to wait for the processor.
  can::Socket socket_{kInterface, {.receive_buffer_bytes = 64 * 1024 * 1024}};
  loop::ObstacleAssembler objects_;
  Cycle heard_;
  bool done_ = false;
};

TEST_F(TrafficOnVcan, SlowVehicleIsOvertakenOnceTheOncomingOneHasGoneBy) {
  constexpr int kSlow = 0;
  constexpr int kOncoming = 1;
  DriveUntil("063-oncoming-360", [](const Cycle& cycle) {
    return cycle.GapBehind(*cycle.Object(kSlow)) > 20.0 && std::abs(cycle.pose.Y) < 0.3;
  });
  ExpectActiveAndApart();

  const auto follows = First([](const Cycle& c) { return c.Decides(ManoeuvreDecision::kFollow, kSlow); });
  ASSERT_NE(follows, cycles_.end());
  EXPECT_EQ(follows->manoeuvre.reason, ManoeuvreReason::kOncomingFirst);
  EXPECT_LT(follows->manoeuvre.stop_distance, follows->GapAhead(*follows->Object(kSlow)));
  EXPECT_NE(First([](const Cycle& c) { return c.acceleration.acceleration < -1.0; }, follows), cycles_.end());

  // Nothing of the vehicle is in the other lane, whose middle is 3.5 m to the left, before the oncoming one is behind.
  const auto beside = First([](const Cycle& c) { return c.pose.Y + kVehicle.half_width > 1.75; });
  ASSERT_NE(beside, cycles_.end());
  EXPECT_GT(beside->GapBehind(*beside->Object(kOncoming)), 0.0);
  EXPECT_GT(beside->GapAhead(*beside->Object(kSlow)), 0.0);
  EXPECT_TRUE(beside->Decides(ManoeuvreDecision::kPass, kSlow));
  EXPECT_EQ(beside->manoeuvre.side, bus::PassingSide::kLeft);
  const auto out = std::max_element(
      follows, beside, [](const Cycle& a, const Cycle& b) { return a.steering.delta < b.steering.delta; });
  EXPECT_GT(out->steering.delta, 0.01);
  EXPECT_NE(First([](const Cycle& c) { return c.steering.delta < -0.01; }, beside), cycles_.end());

  EXPECT_EQ(cycles_.back().manoeuvre.decision, ManoeuvreDecision::kDrive);
  EXPECT_NEAR(cycles_.back().motion.upsilon, 25.0, 0.5);
}

TEST_F(TrafficOnVcan, BeforeABlockedRoadItWaitsWithItsReasonAndDrivesOnWhenTheRoadIsFree) {
  constexpr int kLorry = 0;
  constexpr double kPlace = 120.0;
  DriveUntil("034-blocked-then-free",
             [](const Cycle& cycle) { return cycle.pose.X > kPlace + 20.0 && cycle.motion.upsilon > 9.0; });
  ExpectActiveAndApart();

  const auto free = First([](const Cycle& c) { return c.Object(kLorry) == nullptr; });
  ASSERT_NE(free, cycles_.end());
  const auto stands = First([](const Cycle& c) { return c.motion.upsilon < 0.1; });
  ASSERT_LT(stands, free - 60);  // 3 s, at least
  for (auto cycle = stands; cycle != free; ++cycle) {
    ASSERT_TRUE(cycle->Decides(ManoeuvreDecision::kWait, kLorry));
    ASSERT_EQ(cycle->manoeuvre.reason, ManoeuvreReason::kNoGap);
    ASSERT_LT(cycle->motion.upsilon, 0.2);
    ASSERT_LE(cycle->acceleration.acceleration, 0.0);
  }
  EXPECT_LT(stands->GapAhead(*stands->Object(kLorry)), 5.0);  // it did not stop any sooner than it had to

  const auto goes = First([](const Cycle& c) { return c.acceleration.acceleration > 0.5; }, free);
  EXPECT_LT(goes - free, 20);  // 1 s
  EXPECT_EQ(cycles_.back().manoeuvre.decision, ManoeuvreDecision::kDrive);
  EXPECT_EQ(cycles_.back().manoeuvre.reason, ManoeuvreReason::kWayFree);
}

// In real time, 13 s.
TEST_F(TrafficOnVcan, WhoFollowsCloselyIsNoReasonToBrake) {
  constexpr int kFollower = 0;
  constexpr int kParked = 1;
  DriveUntil(
      "031-follower-10m", [](const Cycle& cycle) { return cycle.GapBehind(*cycle.Object(kParked)) > 20.0; },
      false);
  ExpectActiveAndApart();
  const Cycle& first = cycles_.front();
  EXPECT_LT(first.GapBehind(*first.Object(kFollower)), 11.0);
  for (const Cycle& cycle : cycles_) {
    ASSERT_GT(cycle.motion.upsilon, 14.5) << "X = " << cycle.pose.X;  // of 15 m/s
    ASSERT_GT(cycle.acceleration.acceleration, -0.5) << "X = " << cycle.pose.X;
    ASSERT_NE(cycle.manoeuvre.object_id, kFollower) << "X = " << cycle.pose.X;
    ASSERT_NE(cycle.manoeuvre.decision, ManoeuvreDecision::kWait) << "X = " << cycle.pose.X;
  }
}

}  // namespace
