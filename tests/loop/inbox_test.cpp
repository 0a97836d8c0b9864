#include "loop/inbox.hpp"

#include <gtest/gtest.h>

#include "tests/bus/bus_frames.hpp"

namespace loop {
namespace {

using namespace std::chrono_literals;

class InboxTest : public testing::Test {
 protected:
  // Receives frames; the number of cycles that they ask for.
  int Give(const std::vector<can::Frame>& frames, base::Time now) {
    int due = 0;
    for (const can::Frame& frame : frames) due += inbox_.Receive(frame, now) ? 1 : 0;
    return due;
  }
  Snapshot Take(base::Time now) { return inbox_.TakeSnapshot(now, Trigger::kState); }
  Snapshot TakeByTimer(base::Time now) { return inbox_.TakeSnapshot(now, Trigger::kTimer); }

  bus::VehicleBus bus_;
  Inbox inbox_{bus_, {}, 50ms};
  bus::FakeVehicle vehicle_{bus_};
};

TEST_F(InboxTest, CycleIsDueWithTheLastFrameOfAStateSetAndTheSetWaitsFromThenOn) {
  vehicle_.pose = {.X = 20.0, .Y = -3.0};
  EXPECT_EQ(Give(vehicle_.Request(), 10s), 0);
  EXPECT_EQ(Give(vehicle_.Obstacles(), 10s), 0);
  const auto set = vehicle_.State();
  EXPECT_FALSE(inbox_.Receive(set[0], 10s));
  EXPECT_FALSE(inbox_.Receive(set[1], 10s + 4ms));
  EXPECT_TRUE(inbox_.Receive(set[2], 10s + 7ms));
  const Snapshot known = Take(10s + 12ms);
  EXPECT_TRUE(known.state_new);
  EXPECT_EQ(known.waited, 5ms);
  EXPECT_EQ(known.state.timestamp, 10s);
  EXPECT_NEAR(known.state.z[control::kX], 20.0, 1e-4);
  EXPECT_NEAR(known.state.z[control::kY], -3.0, 1e-4);
  const Snapshot later = TakeByTimer(10s + 62ms);
  EXPECT_FALSE(later.state_new);
  EXPECT_EQ(later.waited, 0ms);
  EXPECT_EQ(later.state.timestamp, 10s);  // The last set remains known.
}

TEST_F(InboxTest, StateThatComesAfterTheTimerOfItsPeriodIsNoFurtherStep) {
  Give(vehicle_.State(), 10s);
  const std::int64_t first = Take(10s).step;
  EXPECT_EQ(TakeByTimer(10s + 50ms).step, first + 1);
  Give(vehicle_.State(), 10s + 60ms);
  EXPECT_EQ(Take(10s + 60ms).step, first + 1);
  Give(vehicle_.State(), 10s + 100ms);  // No cycle answers this set, and it is a step all the same.
  Give(vehicle_.State(), 10s + 150ms);
  EXPECT_EQ(Take(10s + 150ms).step, first + 3);
}

TEST_F(InboxTest, EventBetweenTwoCyclesAppearsInOneSnapshotAndAHeldOverrideInAll) {
  vehicle_.request.engage = true;
  Give(vehicle_.Request(), 10s);
  EXPECT_FALSE(Take(10s).released);
  for (bool bus::DriverRequest::*override_by :
       {&bus::DriverRequest::brake, &bus::DriverRequest::steering_override}) {
    vehicle_.request = {.engage = false};
    vehicle_.request.*override_by = true;
    Give(vehicle_.Request(), 10s);
    vehicle_.request = {.engage = true};
    Give(vehicle_.Request(), 10s);
    const Snapshot touched = Take(10s);
    EXPECT_TRUE(touched.override_seen);
    EXPECT_TRUE(touched.released);
    EXPECT_TRUE(touched.engage);
    const Snapshot next = Take(10s);
    EXPECT_FALSE(next.override_seen);
    EXPECT_FALSE(next.released);
    vehicle_.request.*override_by = true;
    Give(vehicle_.Request(), 10s);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(Take(10s).override_seen);
  }
}

TEST_F(InboxTest, InputsAreFreshForTheConfiguredNumberOfPeriods) {
  EXPECT_FALSE(TakeByTimer(0s).state_fresh);  // The time of a state that never came is zero as well.
  EXPECT_FALSE(TakeByTimer(0s).obstacles_fresh);
  EXPECT_FALSE(TakeByTimer(0s).request_fresh);
  vehicle_.obstacles = {{.object_id = 3, .X = 60.0, .Y = 1.0}};
  Give(vehicle_.All(), 10s);
  const auto expect_fresh_until = [this](base::Time last) {
    for (const bool fresh : {true, false}) {
      const base::Time now = fresh ? last : last + 1ns;
      const Snapshot known = Take(now);
      EXPECT_TRUE(known.state_fresh);
      EXPECT_EQ(known.obstacles_fresh, fresh);
      EXPECT_EQ(known.request_fresh, fresh);
      EXPECT_EQ(known.faulty_message.has_value(), !fresh);
      EXPECT_EQ(known.obstacle_age, now - 10s);
      ASSERT_EQ(known.obstacles.size(), 1U);
      EXPECT_NEAR(known.obstacles[0].X, 60.0, 0.01);
    }
  };
  expect_fresh_until(10s + 150ms);
  inbox_.Reconfigure({.stale_periods = 5.0});
  expect_fresh_until(10s + 250ms);
}

// Both the number of periods and the gap that is bridged must be exceeded.
TEST_F(InboxTest, StateIsOfUseUpToTheConfiguredGap) {
  Give(vehicle_.All(), 10s);
  EXPECT_TRUE(Take(10s + 300ms).state_fresh);
  EXPECT_FALSE(Take(10s + 300ms + 1ns).state_fresh);
  inbox_.Reconfigure({.max_state_gap = 0.2});
  EXPECT_TRUE(Take(10s + 200ms).state_fresh);
  EXPECT_FALSE(Take(10s + 200ms + 1ns).state_fresh);
  inbox_.Reconfigure({.stale_periods = 5.0, .max_state_gap = 0.2});
  EXPECT_TRUE(Take(10s + 250ms).state_fresh);
  EXPECT_FALSE(Take(10s + 250ms + 1ns).state_fresh);
}

TEST_F(InboxTest, RefusedFrameOfAStateIsToldAndCompletesNoSet) {
  auto set = vehicle_.State();
  set[1].data[4] ^= std::byte{1};
  EXPECT_EQ(Give(set, 10s), 0);
  const Snapshot known = TakeByTimer(10s);
  EXPECT_TRUE(known.state_rejected);
  EXPECT_FALSE(known.state.complete);
  ASSERT_TRUE(known.faulty_message);
  EXPECT_EQ(known.faulty_message->message, safety::RxMessage::kMotion);
  EXPECT_EQ(known.faulty_message->reason, safety::RxFault::kWrongCrc);
  EXPECT_FALSE(TakeByTimer(10s + 151ms).state_rejected);  // It is no longer recent.
  auto request = vehicle_.Request();
  request[0].data[4] ^= std::byte{1};
  EXPECT_EQ(Give(request, 11s), 0);
  EXPECT_FALSE(TakeByTimer(11s).state_rejected);  // The request is no part of the state.
}

TEST_F(InboxTest, SilenceIsABusThatNoCycleFoundUpForMoreThanFortyPeriods) {
  static_cast<void>(TakeByTimer(10s));
  EXPECT_FALSE(TakeByTimer(10s + 50ms).silent);
  inbox_.SetBusUp(false);
  EXPECT_FALSE(TakeByTimer(12s + 50ms).silent);
  EXPECT_FALSE(TakeByTimer(12s + 50ms).bus_up);
  EXPECT_TRUE(TakeByTimer(12s + 50ms + 1ns).silent);
  inbox_.SetBusUp(true);
  const Snapshot back = TakeByTimer(13s);
  EXPECT_TRUE(back.bus_up);
  EXPECT_TRUE(back.silent);  // No command has been sent since, so that one cycle more has to know.
  EXPECT_FALSE(TakeByTimer(13s + 50ms).silent);
}

}  // namespace
}  // namespace loop
