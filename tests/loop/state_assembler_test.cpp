#include "loop/state_assembler.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace loop {
namespace {

using namespace std::chrono_literals;

TEST(StateAssembler, SetIsCompleteWithItsThirdFrameInAnyOrder) {
  StateAssembler assembler(50ms);
  EXPECT_FALSE(
      assembler.Update(bus::VehicleFeedback{.psi = 0.5, .delta = 0.1, .acceleration = 1.0}, 4, 12ms));
  EXPECT_FALSE(assembler.Update(bus::VehiclePose{.X = 1.0, .Y = 2.0}, 4, 10ms));
  EXPECT_FALSE(assembler.state().complete);
  EXPECT_TRUE(assembler.Update(bus::VehicleMotion{.upsilon = 3.0, .nu = 4.0, .omega = 5.0}, 4, 14ms));
  const VehicleState& state = assembler.state();
  EXPECT_TRUE(state.complete);
  EXPECT_EQ(state.counter, 4);
  EXPECT_EQ(state.timestamp, 10ms);  // that of the oldest frame
  control::State z;
  z << 1.0, 2.0, 3.0, 4.0, 0.5, 5.0;
  EXPECT_EQ(state.z, z);
  EXPECT_EQ(state.feedback, control::Input(0.1, 1.0));
}

TEST(StateAssembler, FramesOfTwoCountersNeverMakeASet) {
  StateAssembler assembler(50ms);
  EXPECT_FALSE(assembler.Update(bus::VehiclePose{.X = 1.0}, 4, 0ms));
  EXPECT_FALSE(assembler.Update(bus::VehicleMotion{}, 4, 0ms));
  EXPECT_FALSE(assembler.Update(bus::VehicleFeedback{}, 5, 50ms));
  EXPECT_FALSE(assembler.Update(bus::VehicleMotion{}, 5, 50ms));
  EXPECT_EQ(assembler.dropped(), 1U);
  EXPECT_TRUE(assembler.Update(bus::VehiclePose{.X = 2.0}, 5, 50ms));
  EXPECT_EQ(assembler.state().counter, 5);
  EXPECT_EQ(assembler.state().timestamp, 50ms);
}

TEST(StateAssembler, SamePartTwiceBeginsANewSet) {
  StateAssembler assembler(50ms);
  EXPECT_FALSE(assembler.Update(bus::VehiclePose{.X = 1.0}, 4, 0ms));
  EXPECT_FALSE(assembler.Update(bus::VehicleMotion{}, 4, 0ms));
  EXPECT_FALSE(assembler.Update(bus::VehiclePose{.X = 2.0}, 4, 750ms));  // fifteen sets later
  EXPECT_FALSE(assembler.Update(bus::VehicleFeedback{}, 4, 750ms));
  EXPECT_TRUE(assembler.Update(bus::VehicleMotion{}, 4, 750ms));
  EXPECT_EQ(assembler.state().z[control::kX], 2.0);
}

TEST(StateAssembler, PartFromTheRoundBeforeMakesNoSetWithPartsOfThisRound) {
  StateAssembler assembler(50ms);
  EXPECT_FALSE(assembler.Update(bus::VehiclePose{.X = 1.0}, 4, 0ms));  // the rest of 15 sets is lost
  EXPECT_FALSE(assembler.Update(bus::VehicleMotion{}, 4, 750ms));
  EXPECT_FALSE(assembler.Update(bus::VehicleFeedback{}, 4, 750ms));
  EXPECT_TRUE(assembler.Update(bus::VehiclePose{.X = 2.0}, 4, 750ms));
  EXPECT_EQ(assembler.state().z[control::kX], 2.0);
}

TEST(StateAssembler, HeadingIsWrapped) {
  StateAssembler assembler(50ms);
  EXPECT_FALSE(assembler.Update(bus::VehiclePose{}, 0, 0ms));
  EXPECT_FALSE(assembler.Update(bus::VehicleMotion{}, 0, 0ms));
  EXPECT_TRUE(assembler.Update(bus::VehicleFeedback{.psi = 2.0 * std::numbers::pi + 0.25}, 0, 0ms));
  EXPECT_NEAR(assembler.state().z[control::kPsi], 0.25, 1e-12);
}

TEST(StateAssembler, SetWithAValueThatIsNotFiniteIsDropped) {
  StateAssembler assembler(50ms);
  EXPECT_FALSE(assembler.Update(bus::VehiclePose{.X = std::numeric_limits<double>::quiet_NaN()}, 0, 0ms));
  EXPECT_FALSE(assembler.Update(bus::VehicleMotion{}, 0, 0ms));
  EXPECT_FALSE(assembler.Update(bus::VehicleFeedback{}, 0, 0ms));
  EXPECT_FALSE(assembler.state().complete);
  EXPECT_EQ(assembler.dropped(), 1U);
}

}  // namespace
}  // namespace loop
