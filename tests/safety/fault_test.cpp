#include "safety/fault.hpp"

#include <array>
#include <gtest/gtest.h>
#include <set>

#include "bus/message_fields.hpp"
#include "bus/names.hpp"

namespace safety {
namespace {

constexpr int kCauses = static_cast<int>(LastOf(Cause{})) + 1;

TEST(Fault, EachCauseHasARowOfItsOwnWithAText) {
  std::set<std::string_view> texts;
  for (int i = 0; i < kCauses; ++i) {
    const auto cause = static_cast<Cause>(i);
    EXPECT_EQ(RowOf(cause).cause, cause);
    EXPECT_TRUE(texts.insert(Name(cause)).second) << Name(cause);
  }
}

TEST(Fault, AnEventHasNoCodeAndEveryFaultHasOne) {
  for (int i = 0; i < kCauses; ++i) {
    const CauseRow& row = RowOf(static_cast<Cause>(i));
    EXPECT_EQ(row.severity == Severity::kEvent, row.code == bus::FaultCode::kNone) << Name(row.cause);
  }
}

TEST(Fault, OnlyWhatCannotBeDoneWithoutIsHard) {
  const std::set<Cause> hard{Cause::kBusDown,       Cause::kStateStale,    Cause::kStateInvalid,
                             Cause::kRouteEnd,      Cause::kPlanExhausted, Cause::kSilent,
                             Cause::kInternalError, Cause::kStopDue};
  for (int i = 0; i < kCauses; ++i) {
    const auto cause = static_cast<Cause>(i);
    EXPECT_EQ(IsHard(cause), hard.contains(cause)) << Name(cause);
  }
}

TEST(Fault, ACauseAndItsCodeReadAlike) {
  // Causes that share their code with others.
  const std::set<Cause> other{Cause::kSilent, Cause::kSolverFailed, Cause::kStopDue};
  for (int i = 0; i < kCauses; ++i) {
    const auto cause = static_cast<Cause>(i);
    if (RowOf(cause).severity == Severity::kEvent || other.contains(cause)) continue;
    EXPECT_EQ(Name(cause), bus::Name(FaultOf(cause)));
  }
  EXPECT_EQ(FaultOf(Cause::kSilent), bus::FaultCode::kInternalError);
  EXPECT_EQ(FaultOf(Cause::kStopDue), bus::FaultCode::kPlanRejected);
  EXPECT_EQ(FaultOf(Cause::kSolverFailed), bus::FaultCode::kSolverNumericalFailure);
}

}  // namespace
}  // namespace safety
