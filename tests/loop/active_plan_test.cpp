#include "loop/active_plan.hpp"

#include <cstdint>
#include <gtest/gtest.h>

#include "tests/support/allocations.hpp"

namespace loop {
namespace {

constexpr int kHorizon = 4;
// A step that does not fit into 32 bits: a daemon counts steps for as long as it runs.
constexpr std::int64_t kMade = std::int64_t{1} << 40;

control::Input Nth(int i) {
  return {0.01 * (i + 1), -0.1 * (i + 1)};
}

control::Plan PlanOf(int steps) {
  control::Plan plan;
  for (int i = 0; i < steps; ++i) plan.u.push_back(Nth(i));
  return plan;
}

TEST(ActivePlanTest, EachStepOfTheHorizonHasItsOwnInputAndNoOtherStepHasOne) {
  ActivePlan active(kHorizon);
  active.Set(PlanOf(kHorizon), kMade);
  EXPECT_TRUE(active.exists());
  for (int i = 0; i < kHorizon; ++i) {
    ASSERT_TRUE(active.Covers(kMade + i));
    EXPECT_EQ(active.At(kMade + i), Nth(i));
    EXPECT_EQ(active.Age(kMade + i), i);
    EXPECT_EQ(active.Left(kMade + i), kHorizon - 1 - i);
  }
  for (const std::int64_t step : {kMade - 1, kMade + kHorizon, std::int64_t{0}}) {
    EXPECT_FALSE(active.Covers(step));
    EXPECT_EQ(active.Left(step), 0);
  }
}

TEST(ActivePlanTest, RestOfThePlanBeginsAtTheStepAndEndsWithTheLastInput) {
  ActivePlan active(kHorizon);
  active.Set(PlanOf(kHorizon), kMade);
  for (int i = 0; i < kHorizon; ++i) {
    const auto rest = active.From(kMade + i);
    ASSERT_EQ(rest.size(), static_cast<std::size_t>(kHorizon - i));
    EXPECT_EQ(rest.front(), Nth(i));
    EXPECT_EQ(rest.back(), Nth(kHorizon - 1));
  }
  EXPECT_TRUE(active.From(kMade - 1).empty());
  EXPECT_TRUE(active.From(kMade + kHorizon + 1).empty());
}

TEST(ActivePlanTest, NewPlanLeavesNothingOfTheOldOne) {
  ActivePlan active(kHorizon);
  active.Set(PlanOf(kHorizon), kMade);
  active.Set(PlanOf(2), kMade + 1);
  EXPECT_FALSE(active.Covers(kMade));
  EXPECT_EQ(active.At(kMade + 1), Nth(0));
  EXPECT_EQ(active.Age(kMade + 1), 0);
  EXPECT_EQ(active.From(kMade + 1).size(), 2U);
  EXPECT_FALSE(active.Covers(kMade + 3));  // The old plan had an input for this step.
}

TEST(ActivePlanTest, WithoutAPlanNoStepIsCovered) {
  ActivePlan active(kHorizon);
  for (int i = 0; i < 2; ++i) {  // The plan is first one that was never made, then one that was dropped.
    EXPECT_FALSE(active.exists());
    EXPECT_FALSE(active.Covers(0));
    EXPECT_FALSE(active.Covers(kMade));
    EXPECT_EQ(active.Left(kMade), 0);
    EXPECT_TRUE(active.From(kMade).empty());
    active.Set(PlanOf(kHorizon), kMade);
    EXPECT_TRUE(active.exists());
    active.Clear();
  }
}

TEST(ActivePlanTest, InputsAreCopiedWithoutAnAllocation) {
  ActivePlan active(kHorizon);
  control::Plan plan = PlanOf(kHorizon);
  const std::size_t before = test_support::Allocations();
  active.Set(plan, kMade);
  active.Clear();
  active.Set(plan, kMade);
  EXPECT_EQ(test_support::Allocations(), before);
  plan.u[1] = control::Input::Zero();  // The controller makes its next plan in the same place.
  EXPECT_EQ(active.At(kMade + 1), Nth(1));
}

}  // namespace
}  // namespace loop
