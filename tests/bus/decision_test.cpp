// Decisions in words, and their changes.
#include <gtest/gtest.h>
#include <set>
#include <string>

#include "bus/decision_change.hpp"
#include "bus/message_fields.hpp"
#include "bus/names.hpp"

namespace bus {
namespace {

constexpr ManoeuvreStatus kPasses{.decision = ManoeuvreDecision::kPass,
                                  .reason = ManoeuvreReason::kWayFree,
                                  .object_id = 3,
                                  .side = PassingSide::kLeft};

TEST(ManoeuvreText, TellsWhatIsDoneAboutWhichObjectAndWhy) {
  EXPECT_EQ(ManoeuvreText(kPasses), "passes object 3 on the left: the way is free");
  EXPECT_EQ(ManoeuvreText(
                {.decision = ManoeuvreDecision::kWait, .reason = ManoeuvreReason::kNoGap, .object_id = 0}),
            "waits behind object 0: no gap is wide enough");
  EXPECT_EQ(ManoeuvreText({.decision = ManoeuvreDecision::kWait, .reason = ManoeuvreReason::kRoadTooNarrow}),
            "waits: the road is too narrow");
  EXPECT_EQ(DecisionText({.decision = ManoeuvreDecision::kYield,
                          .reason = ManoeuvreReason::kCrossingFirst,
                          .object_id = 63}),
            "yields to object 63");
  EXPECT_EQ(ManoeuvreText({}), "no decision");
}

TEST(ManoeuvreText, EachDecisionAndReasonHasAnotherText) {
  std::set<std::string> texts;
  std::size_t count = 0;
  for (int d = 0; d <= static_cast<int>(LastOf(ManoeuvreDecision{})); ++d, ++count) {
    texts.insert(DecisionText({.decision = static_cast<ManoeuvreDecision>(d)}));
  }
  for (int r = 0; r <= static_cast<int>(LastOf(ManoeuvreReason{})); ++r, ++count) {
    texts.emplace(Name(static_cast<ManoeuvreReason>(r)));
  }
  EXPECT_EQ(texts.size(), count);
}

// Takes the same decision in several cycles. Returns in which of them, counted from 1, it was told; 0: in none.
int ToldAfter(DecisionChange& change, const ManoeuvreStatus& manoeuvre, int cycles) {
  for (int cycle = 1; cycle <= cycles; ++cycle) {
    if (change.Take(manoeuvre)) return cycle;
  }
  return 0;
}

class DecisionChangeTest : public testing::Test {
 protected:
  DecisionChangeTest() {
    EXPECT_FALSE(change_.Take({}));
    EXPECT_TRUE(change_.Take(kPasses)) << "the first is told at once";
  }

  DecisionChange change_;
  ManoeuvreStatus other_ = kPasses;
};

TEST_F(DecisionChangeTest, ADecisionIsToldOnce) {
  EXPECT_EQ(ToldAfter(change_, kPasses, 100), 0);
  EXPECT_FALSE(change_.Take({})) << "a cycle without a plan";
  other_.stop_distance = 3.0;
  EXPECT_EQ(ToldAfter(change_, other_, 100), 0) << "it is the same decision at another place";
}

TEST_F(DecisionChangeTest, AnotherDecisionObjectOrSideIsToldOnceItHolds) {
  other_.side = PassingSide::kRight;
  EXPECT_EQ(ToldAfter(change_, other_, 100), DecisionChange::kSteady);
  EXPECT_EQ(change_.held(), DecisionChange::kSteady);
  other_.object_id = 4;
  EXPECT_EQ(ToldAfter(change_, other_, 100), DecisionChange::kSteady);
  other_.decision = ManoeuvreDecision::kFollow;
  EXPECT_EQ(ToldAfter(change_, other_, 100), DecisionChange::kSteady);
  other_.side = PassingSide::kUnknown;
  EXPECT_EQ(ToldAfter(change_, other_, 100), 0) << "not known is no other side";
}

TEST_F(DecisionChangeTest, AnotherReasonIsToldOnceItHoldsForLonger) {
  other_.reason = ManoeuvreReason::kStayingCosts;
  EXPECT_EQ(ToldAfter(change_, other_, 100), DecisionChange::kSteadyReason);
}

TEST_F(DecisionChangeTest, WhatIsGivenUpAtOnceIsNotTold) {
  ManoeuvreStatus follows = kPasses;
  follows.decision = ManoeuvreDecision::kFollow;
  for (int k = 0; k < 20; ++k) {
    EXPECT_EQ(ToldAfter(change_, follows, DecisionChange::kSteady - 1), 0);
    EXPECT_FALSE(change_.Take(kPasses));
  }
  // Another decision for changing reasons holds all the same.
  EXPECT_EQ(ToldAfter(change_, follows, DecisionChange::kSteady - 1), 0);
  follows.reason = ManoeuvreReason::kTooLate;
  EXPECT_TRUE(change_.Take(follows));
}

TEST_F(DecisionChangeTest, ThatTheMarginsAreUsedUpIsToldAtOnce) {
  other_.decision = ManoeuvreDecision::kSqueeze;
  EXPECT_TRUE(change_.Take(other_));
  EXPECT_EQ(change_.held(), 1);
  EXPECT_FALSE(change_.Take(other_));
}

TEST_F(DecisionChangeTest, AfterAResetTheSameDecisionIsToldAgain) {
  change_.Reset();
  EXPECT_TRUE(change_.Take(kPasses));
}

}  // namespace
}  // namespace bus
