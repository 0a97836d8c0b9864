#include "safety/faulty_message.hpp"

#include <gtest/gtest.h>

#include "bus/vehicle_bus.hpp"
#include "tests/bus/bus_frames.hpp"

namespace safety {
namespace {

using namespace std::chrono_literals;

class FaultyMessageTest : public testing::Test {
 protected:
  // Receives all messages except the one with `id`; all if `id` is 0.
  void ReceiveAllBut(std::uint32_t id) {
    vehicle_.obstacles = {{.object_id = 1, .X = 50.0}};
    for (const can::Frame& frame : vehicle_.All()) {
      if (frame.id != id) static_cast<void>(monitor_.Check(frame, now_));
    }
  }
  template <typename Typed>
  std::uint32_t IdOf() const {
    return bus_.Info<Typed>().id;
  }

  bus::VehicleBus bus_;
  MessageMonitor monitor_{bus_, {}, 50ms};
  bus::FakeVehicle vehicle_{bus_};
  base::Time now_ = 10s;
};

TEST_F(FaultyMessageTest, NoneWhileAllAreFresh) {
  ReceiveAllBut(0);
  EXPECT_FALSE(FindFaultyMessage(monitor_, now_));
}

TEST_F(FaultyMessageTest, WithoutObstaclesThereIsNoObstacleObject) {
  ReceiveAllBut(IdOf<bus::ObstaclePosition>());
  EXPECT_FALSE(FindFaultyMessage(monitor_, now_));
}

TEST_F(FaultyMessageTest, TheFirstThatDoesNotComeIsNamedWithoutAReason) {
  const auto none = FindFaultyMessage(monitor_, now_);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->message, RxMessage::kPose);
  EXPECT_FALSE(none->reason);

  ReceiveAllBut(IdOf<bus::DriverRequest>());
  const auto last = FindFaultyMessage(monitor_, now_);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->message, RxMessage::kDriverRequest);
  EXPECT_FALSE(last->reason);
}

TEST_F(FaultyMessageTest, OneThatIsRefusedIsNamedWithTheReason) {
  for (int i = 0; i < 10; ++i) {
    now_ += 50ms;
    for (can::Frame frame : vehicle_.All()) {
      if (frame.id == IdOf<bus::VehicleMotion>()) frame.data[0] ^= std::byte{1};
      static_cast<void>(monitor_.Check(frame, now_));
    }
  }
  const auto faulty = FindFaultyMessage(monitor_, now_);
  ASSERT_TRUE(faulty);
  EXPECT_EQ(faulty->message, RxMessage::kMotion);
  EXPECT_EQ(faulty->reason, RxFault::kWrongCrc);
}

TEST_F(FaultyMessageTest, ObstacleObjectsThatAreRefusedAreNamed) {
  for (int i = 0; i < 10; ++i) {
    now_ += 50ms;
    vehicle_.obstacles = {{.object_id = 1, .X = 50.0}};
    for (can::Frame frame : vehicle_.All()) {
      if (frame.id == IdOf<bus::ObstaclePosition>()) frame.data[0] ^= std::byte{1};
      static_cast<void>(monitor_.Check(frame, now_));
    }
  }
  const auto faulty = FindFaultyMessage(monitor_, now_);
  ASSERT_TRUE(faulty);
  EXPECT_EQ(faulty->message, RxMessage::kObstacleObject);
}

}  // namespace
}  // namespace safety
