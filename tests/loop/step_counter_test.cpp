#include "loop/step_counter.hpp"

#include <gtest/gtest.h>

namespace loop {
namespace {

// A counter that has seen the state of step 100.
class StepCounterTest : public testing::Test {
 protected:
  StepCounterTest() {
    counter_.CountState(CounterAt(100));
    offset_ = 100 - counter_.step();
  }
  static std::uint8_t CounterAt(std::int64_t step) { return static_cast<std::uint8_t>(step % 15); }
  std::int64_t State(std::int64_t step) {
    counter_.CountState(CounterAt(step));
    return counter_.step() + offset_;
  }
  std::int64_t Timer(int times) {
    for (int i = 0; i < times; ++i) counter_.CountTimer();
    return counter_.step() + offset_;
  }

  StepCounter counter_;
  std::int64_t offset_ = 0;
};

TEST_F(StepCounterTest, StatesInSequenceAreStepsInSequence) {
  for (std::int64_t step = 101; step < 200; ++step) EXPECT_EQ(State(step), step);
}

TEST_F(StepCounterTest, MissingStatesAreStepsToo) {
  EXPECT_EQ(State(102), 102);
  EXPECT_EQ(State(109), 109);
}

// Whatever the number of missing states, the timer's count may be wrong by up to seven.
TEST_F(StepCounterTest, TheTimersCountNeedsOnlyBeRoughlyRight) {
  for (int missing = 1; missing < 100; ++missing) {
    for (int error = -7; error <= 7; ++error) {
      if (missing + error < 0) continue;
      StepCounter counter;
      counter.CountState(CounterAt(100));
      const std::int64_t start = counter.step();
      for (int i = 0; i < missing + error; ++i) counter.CountTimer();
      counter.CountState(CounterAt(100 + missing));
      EXPECT_EQ(counter.step() - start, missing) << "counted " << missing + error;
    }
  }
}

TEST_F(StepCounterTest, StateThatComesAfterItsTimerCycleIsTheSameStep) {
  EXPECT_EQ(Timer(1), 101);
  EXPECT_EQ(State(101), 101);
}

TEST_F(StepCounterTest, VehicleThatCountsAnewDoesNotMoveTheStep) {
  EXPECT_EQ(Timer(4), 104);
  EXPECT_EQ(State(98), 104);  // not 113
  counter_.CountState(CounterAt(99));
  EXPECT_EQ(counter_.step() + offset_, 105);
}

TEST_F(StepCounterTest, EveryStateIsALaterStep) {
  EXPECT_GT(State(94), 100);
}

}  // namespace
}  // namespace loop
