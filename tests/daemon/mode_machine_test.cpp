#include "daemon/mode_machine.hpp"

#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace lpvmpcd {
namespace {

// Everything well, engaged for some time.
ModeInputs Well() {
  return {.bus_up = true,
          .state_new = true,
          .state_fresh = true,
          .obstacles_fresh = true,
          .request_fresh = true,
          .engage = true,
          .near_route = true,
          .plan_usable = true,
          .plan_left = 7,
          .route_left = 100};
}

// Degraded for some time, with some to go.
ModeState In(Mode mode, bool armed = false) {
  return {.mode = mode,
          .cause = Cause::kStart,
          .healthy_cycles = kHealthyCycles,
          .armed = armed,
          .degraded_left = 5};
}

struct Row {
  std::string event;
  std::function<void(ModeInputs&)> happens;
  // Mode after one cycle, and the cause if it is another one; by mode before.
  struct To {
    Mode mode;
    Cause cause = Cause::kStart;
  };
  To init, standby, active, degraded, safe_stop, fault;
};

const Row::To kStaysInInit{Mode::kInit};
const Row::To kStaysInStandby{Mode::kStandby};
const Row::To kStaysInActive{Mode::kActive};
const Row::To kStaysInDegraded{Mode::kDegraded};
const Row::To kStaysInSafeStop{Mode::kSafeStop};
const Row::To kStaysInFault{Mode::kFault};
const Row::To kComesUp{Mode::kStandby, Cause::kInputsHealthy};
const Row::To kGoesOn{Mode::kActive, Cause::kRecovered};
const Row::To kRecovers{Mode::kStandby, Cause::kRecovered};
const Row::To kYields{Mode::kStandby, Cause::kOverride};
const Row::To kLetsGo{Mode::kStandby, Cause::kReleased};
const Row::To kStands{Mode::kStandby, Cause::kStandstill};
const Row::To kFails{Mode::kFault, Cause::kInternalError};

Row::To Degrades(Cause cause) {
  return {Mode::kDegraded, cause};
}
Row::To Stops(Cause cause) {
  return {Mode::kSafeStop, cause};
}
Row::To Gives(Cause cause) {
  return {Mode::kFault, cause};
}

// Standby is not armed here: edges have their own tests. A row a event, a column a mode.
const std::vector<Row> kTable = {
    // clang-format off
    {"nothing", [](ModeInputs&) {},
     kComesUp, kStaysInStandby, kStaysInActive, kGoesOn, kStaysInSafeStop, kStaysInFault},
    {"brake or steering", [](ModeInputs& i) { i.override_seen = true; },
     kComesUp, kStaysInStandby, kYields, kYields, kYields, kStaysInFault},
    {"request withdrawn", [](ModeInputs& i) { i.engage = false; },
     kComesUp, kStaysInStandby, kLetsGo, kLetsGo, kLetsGo, kRecovers},
    {"bus down", [](ModeInputs& i) { i.bus_up = false; },
     kStaysInInit, kStaysInStandby, Stops(Cause::kBusDown), Stops(Cause::kBusDown), kStaysInSafeStop, kStaysInFault},
    {"state stale", [](ModeInputs& i) { i.state_fresh = false; },
     kStaysInInit, kStaysInStandby, Stops(Cause::kStateStale), Stops(Cause::kStateStale), kStaysInSafeStop,
     kStaysInFault},
    {"state refused", [](ModeInputs& i) { i.state_fresh = false; i.state_rejected = true; },
     kStaysInInit, kStaysInStandby, Stops(Cause::kStateInvalid), Stops(Cause::kStateInvalid), kStaysInSafeStop,
     kStaysInFault},
    {"state late", [](ModeInputs& i) { i.state_new = false; i.plan_fault = Cause::kStateLate; },
     kComesUp, kStaysInStandby, Degrades(Cause::kStateLate), kStaysInDegraded, kStaysInSafeStop, kStaysInFault},
    {"obstacles stale", [](ModeInputs& i) { i.obstacles_fresh = false; },
     kStaysInInit, kStaysInStandby, Degrades(Cause::kObstaclesStale), kStaysInDegraded, kStaysInSafeStop,
     kStaysInFault},
    {"request stale", [](ModeInputs& i) { i.request_fresh = false; },
     kStaysInInit, kStaysInStandby, Degrades(Cause::kDriverRequestStale), kStaysInDegraded, kStaysInSafeStop,
     kStaysInFault},
    {"request stale and off", [](ModeInputs& i) { i.request_fresh = false; i.engage = false; },
     kStaysInInit, kStaysInStandby, Degrades(Cause::kDriverRequestStale), kStaysInDegraded, kStaysInSafeStop,
     kStaysInFault},
    {"problem not solved", [](ModeInputs& i) { i.plan_fault = Cause::kSolverFailed; },
     kComesUp, kStaysInStandby, Degrades(Cause::kSolverFailed), kStaysInDegraded, kStaysInSafeStop, kStaysInFault},
    {"deadline missed", [](ModeInputs& i) { i.plan_fault = Cause::kDeadlineMissed; },
     kComesUp, kStaysInStandby, Degrades(Cause::kDeadlineMissed), kStaysInDegraded, kStaysInSafeStop, kStaysInFault},
    {"plan rejected", [](ModeInputs& i) { i.plan_fault = Cause::kPlanRejected; },
     kComesUp, kStaysInStandby, Degrades(Cause::kPlanRejected), kStaysInDegraded, kStaysInSafeStop, kStaysInFault},
    {"plan exhausted", [](ModeInputs& i) { i.plan_fault = Cause::kSolverFailed; i.plan_usable = false; },
     kComesUp, kStaysInStandby, Stops(Cause::kPlanExhausted), Stops(Cause::kPlanExhausted), kStaysInSafeStop,
     kStaysInFault},
    {"off route", [](ModeInputs& i) { i.near_route = false; },
     kComesUp, kStaysInStandby, kStaysInActive, kGoesOn, kStaysInSafeStop, kStaysInFault},
    {"route end", [](ModeInputs& i) { i.route_left = 0; },
     kComesUp, kStaysInStandby, Stops(Cause::kRouteEnd), Stops(Cause::kRouteEnd), kStaysInSafeStop, kStaysInFault},
    {"standstill", [](ModeInputs& i) { i.standstill = true; },
     kComesUp, kStaysInStandby, kStaysInActive, kGoesOn, kStands, kStaysInFault},
    {"silence", [](ModeInputs& i) { i.silent = true; },
     kComesUp, kStaysInStandby, Gives(Cause::kSilent), Gives(Cause::kSilent), Gives(Cause::kSilent), kStaysInFault},
    {"silence, bus down", [](ModeInputs& i) { i.silent = true; i.bus_up = false; },
     kStaysInInit, kStaysInStandby, Gives(Cause::kBusDown), Gives(Cause::kBusDown), Gives(Cause::kBusDown),
     kStaysInFault},
    {"timer cycle", [](ModeInputs& i) { i.state_new = false; },
     kComesUp, kStaysInStandby, kStaysInActive, kGoesOn, kStaysInSafeStop, kStaysInFault},
    {"internal error", [](ModeInputs& i) { i.internal_error = true; },
     kFails, kFails, kFails, kFails, kFails, kStaysInFault},
    // An override wins over whatever comes with it.
    {"brake, and all else fails",
     [](ModeInputs& i) { i = {.override_seen = true, .plan_fault = Cause::kStateLate, .silent = true}; },
     kStaysInInit, kStaysInStandby, kYields, kYields, kYields, kStaysInFault},
    // clang-format on
};

TEST(ModeMachine, EveryModeAnswersEveryEventAsTheTableSays) {
  for (const Row& row : kTable) {
    ModeInputs inputs = Well();
    row.happens(inputs);
    for (const auto& [before, to] :
         {std::pair(Mode::kInit, row.init), std::pair(Mode::kStandby, row.standby),
          std::pair(Mode::kActive, row.active), std::pair(Mode::kDegraded, row.degraded),
          std::pair(Mode::kSafeStop, row.safe_stop), std::pair(Mode::kFault, row.fault)}) {
      const ModeState after = Next(In(before), inputs);
      EXPECT_EQ(after.mode, to.mode) << Name(before) << ", " << row.event << ": " << Name(after.mode);
      EXPECT_EQ(after.cause, to.cause) << Name(before) << ", " << row.event << ": " << Name(after.cause);
      if (after.mode != before) {
        EXPECT_EQ(after.previous, before) << Name(before) << ", " << row.event;
      }
    }
  }
}

TEST(ModeMachine, DegradedCountsDownToAStop) {
  const ModeSettings settings{.degraded_cycles = 3};
  ModeInputs inputs = Well();
  inputs.obstacles_fresh = false;
  ModeState state = In(Mode::kActive);
  for (const int left : {2, 1, 0}) {
    state = Next(state, inputs, settings);
    EXPECT_EQ(state.mode, Mode::kDegraded);
    EXPECT_EQ(state.degraded_left, left);
  }
  inputs.obstacles_fresh = true;
  inputs.plan_fault = Cause::kDeadlineMissed;  // something else is missing now; the count goes on
  state = Next(state, inputs, settings);
  EXPECT_EQ(state.mode, Mode::kSafeStop);
  EXPECT_EQ(state.cause, Cause::kDeadlineMissed);
}

TEST(ModeMachine, AfterRecoveryTheCountBeginsAnew) {
  const ModeSettings settings{.degraded_cycles = 2};
  ModeInputs stale = Well();
  stale.request_fresh = false;
  ModeState state = Next(Next(In(Mode::kActive), stale, settings), Well(), settings);
  EXPECT_EQ(state.mode, Mode::kActive);
  state = Next(Next(state, stale, settings), stale, settings);
  EXPECT_EQ(state.mode, Mode::kDegraded);
  EXPECT_EQ(Next(state, stale, settings).mode, Mode::kSafeStop);
}

TEST(ModeMachine, WithNoTimeToSpendInDegradedItStopsAtOnce) {
  ModeInputs inputs = Well();
  inputs.plan_fault = Cause::kSolverFailed;
  const ModeState state = Next(In(Mode::kActive), inputs, {.degraded_cycles = 0});
  EXPECT_EQ(state.mode, Mode::kSafeStop);
  EXPECT_EQ(state.cause, Cause::kSolverFailed);
}

TEST(ModeMachine, InitIsLeftAfterThreeHealthyCyclesInARow) {
  ModeState state;
  ModeInputs inputs = Well();
  inputs.engage = false;
  state = Next(Next(state, inputs), inputs);
  EXPECT_EQ(state.mode, Mode::kInit);
  inputs.obstacles_fresh = false;
  state = Next(state, inputs);
  inputs.obstacles_fresh = true;
  state = Next(Next(state, inputs), inputs);
  EXPECT_EQ(state.mode, Mode::kInit);
  state = Next(state, inputs);
  EXPECT_EQ(state.mode, Mode::kStandby);
}

TEST(ModeMachine, RequestHeldFromTheStartDoesNotEngage) {
  ModeState state;
  for (int i = 0; i < 20; ++i) {
    state = Next(state, Well());
  }
  EXPECT_EQ(state.mode, Mode::kStandby);
}

TEST(ModeMachine, RisingEdgeSeenInStandbyEngages) {
  ModeInputs inputs = Well();
  inputs.engage = false;
  ModeState state = Next(In(Mode::kStandby), inputs);
  EXPECT_EQ(state.mode, Mode::kStandby);
  inputs.engage = true;
  EXPECT_TRUE(EngagementRequested(state, inputs));
  state = Next(state, inputs);
  EXPECT_EQ(state.mode, Mode::kActive);
  EXPECT_EQ(state.cause, Cause::kEngaged);
}

TEST(ModeMachine, EdgeBetweenTwoCyclesEngages) {
  ModeInputs inputs = Well();
  inputs.released = true;
  EXPECT_EQ(Next(In(Mode::kStandby), inputs).mode, Mode::kActive);
}

TEST(ModeMachine, ReleaseBetweenTwoCyclesEndsActive) {
  ModeInputs inputs = Well();
  inputs.released = true;
  EXPECT_EQ(Next(In(Mode::kActive), inputs).mode, Mode::kStandby);
}

TEST(ModeMachine, EdgeWhileSomethingIsMissingIsSpent) {
  const std::vector<std::pair<std::string, std::function<void(ModeInputs&)>>> missing = {
      {"bus", [](ModeInputs& i) { i.bus_up = false; }},
      {"state", [](ModeInputs& i) { i.state_fresh = false; }},
      {"obstacles", [](ModeInputs& i) { i.obstacles_fresh = false; }},
      {"request", [](ModeInputs& i) { i.request_fresh = false; }},
      {"override", [](ModeInputs& i) { i.override_seen = true; }},
      {"place", [](ModeInputs& i) { i.near_route = false; }},
      {"route", [](ModeInputs& i) { i.route_left = 0; }},
      {"plan", [](ModeInputs& i) { i.plan_usable = false; }}};
  for (const auto& [name, happens] : missing) {
    ModeInputs inputs = Well();
    happens(inputs);
    ModeState state = Next(In(Mode::kStandby, true), inputs);
    EXPECT_EQ(state.mode, Mode::kStandby) << name;
    for (int i = 0; i < 5; ++i) {
      state = Next(state, Well());
      EXPECT_EQ(state.mode, Mode::kStandby) << name;
    }
  }
}

TEST(ModeMachine, EdgeInATimerCycleWaitsForTheNextState) {
  ModeInputs inputs = Well();
  inputs.state_new = false;
  const ModeState state = Next(In(Mode::kStandby, true), inputs);
  EXPECT_EQ(state.mode, Mode::kStandby);
  EXPECT_EQ(Next(state, Well()).mode, Mode::kActive);
}

TEST(ModeMachine, EdgeInATimerCycleIsSpentByAnOverride) {
  ModeInputs inputs = Well();
  inputs.state_new = false;
  inputs.override_seen = true;
  const ModeState state = Next(In(Mode::kStandby, true), inputs);
  EXPECT_EQ(Next(state, Well()).mode, Mode::kStandby);
}

TEST(ModeMachine, AfterAnOverrideTheDriverHasToAskAgain) {
  ModeInputs inputs = Well();
  inputs.override_seen = true;
  ModeState state = Next(In(Mode::kActive), inputs);
  EXPECT_EQ(state.mode, Mode::kStandby);
  state = Next(Next(state, Well()), Well());
  EXPECT_EQ(state.mode, Mode::kStandby);
}

TEST(ModeMachine, OnlyActiveDegradedAndSafeStopCommand) {
  for (const Mode mode : {Mode::kActive, Mode::kDegraded, Mode::kSafeStop}) {
    EXPECT_TRUE(Commands(mode));
    EXPECT_EQ(Drives(mode), mode != Mode::kSafeStop);
  }
  for (const Mode mode : {Mode::kInit, Mode::kStandby, Mode::kFault}) {
    EXPECT_FALSE(Commands(mode));
    EXPECT_FALSE(Drives(mode));
  }
}

TEST(ModeMachine, FaultsHaveACodeAndEventsHaveNone) {
  EXPECT_EQ(FaultOf(Cause::kBusDown), dbc::FaultCode::kBusDown);
  EXPECT_EQ(FaultOf(Cause::kStateStale), dbc::FaultCode::kStateStale);
  EXPECT_EQ(FaultOf(Cause::kStateInvalid), dbc::FaultCode::kStateInvalid);
  EXPECT_EQ(FaultOf(Cause::kObstaclesStale), dbc::FaultCode::kObstaclesStale);
  EXPECT_EQ(FaultOf(Cause::kDriverRequestStale), dbc::FaultCode::kDriverRequestStale);
  EXPECT_EQ(FaultOf(Cause::kRouteEnd), dbc::FaultCode::kRouteEnd);
  EXPECT_EQ(FaultOf(Cause::kPlanExhausted), dbc::FaultCode::kPlanExhausted);
  EXPECT_EQ(FaultOf(Cause::kStateLate), dbc::FaultCode::kStateLate);
  EXPECT_EQ(FaultOf(Cause::kDeadlineMissed), dbc::FaultCode::kDeadlineMissed);
  EXPECT_EQ(FaultOf(Cause::kPlanRejected), dbc::FaultCode::kPlanRejected);
  EXPECT_EQ(FaultOf(Cause::kSilent), dbc::FaultCode::kInternalError);
  EXPECT_EQ(FaultOf(Cause::kInternalError), dbc::FaultCode::kInternalError);
  for (const Cause event : {Cause::kStart, Cause::kInputsHealthy, Cause::kEngaged, Cause::kReleased,
                            Cause::kOverride, Cause::kStandstill, Cause::kRecovered}) {
    EXPECT_EQ(FaultOf(event), dbc::FaultCode::kNone) << Name(event);
  }
}

}  // namespace
}  // namespace lpvmpcd
