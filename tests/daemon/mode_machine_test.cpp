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
          .plan_usable = true};
}

ModeState In(Mode mode, bool armed = false) {
  return {.mode = mode, .cause = Cause::kStart, .healthy_cycles = kHealthyCycles, .armed = armed};
}

struct Row {
  std::string event;
  std::function<void(ModeInputs&)> happens;
  // Mode after one cycle, and the cause if it is another one; by mode before.
  struct To {
    Mode mode;
    Cause cause = Cause::kStart;
  };
  To init, standby, active, safe_stop, fault;
};

const Row::To kStaysInInit{Mode::kInit};
const Row::To kStaysInStandby{Mode::kStandby};
const Row::To kStaysInActive{Mode::kActive};
const Row::To kStaysInSafeStop{Mode::kSafeStop};
const Row::To kStaysInFault{Mode::kFault};
const Row::To kComesUp{Mode::kStandby, Cause::kInputsHealthy};
const Row::To kRecovers{Mode::kStandby, Cause::kRecovered};
const Row::To kYields{Mode::kStandby, Cause::kOverride};
const Row::To kFails{Mode::kFault, Cause::kInternalError};

Row::To Stops(Cause cause) {
  return {Mode::kSafeStop, cause};
}

// Standby is not armed here: edges have their own tests.
const std::vector<Row> kTable = {
    {"nothing", [](ModeInputs&) {}, kComesUp, kStaysInStandby, kStaysInActive, kStaysInSafeStop,
     kStaysInFault},
    {"brake or steering", [](ModeInputs& i) { i.override_seen = true; }, kComesUp, kStaysInStandby, kYields,
     kYields, kStaysInFault},
    {"request withdrawn",
     [](ModeInputs& i) { i.engage = false; },
     kComesUp,
     kStaysInStandby,
     {Mode::kStandby, Cause::kReleased},
     kStaysInSafeStop,
     kRecovers},
    {"bus down", [](ModeInputs& i) { i.bus_up = false; }, kStaysInInit, kStaysInStandby,
     Stops(Cause::kBusDown), kStaysInSafeStop, kStaysInFault},
    {"state stale", [](ModeInputs& i) { i.state_fresh = false; }, kStaysInInit, kStaysInStandby,
     Stops(Cause::kStateStale), kStaysInSafeStop, kStaysInFault},
    {"state refused",
     [](ModeInputs& i) {
       i.state_fresh = false;
       i.state_rejected = true;
     },
     kStaysInInit, kStaysInStandby, Stops(Cause::kStateInvalid), kStaysInSafeStop, kStaysInFault},
    {"obstacles stale", [](ModeInputs& i) { i.obstacles_fresh = false; }, kStaysInInit, kStaysInStandby,
     Stops(Cause::kObstaclesStale), kStaysInSafeStop, kStaysInFault},
    {"request stale", [](ModeInputs& i) { i.request_fresh = false; }, kStaysInInit, kStaysInStandby,
     Stops(Cause::kDriverRequestStale), kStaysInSafeStop, kStaysInFault},
    {"request stale and off",
     [](ModeInputs& i) {
       i.request_fresh = false;
       i.engage = false;
     },
     kStaysInInit, kStaysInStandby, Stops(Cause::kDriverRequestStale), kStaysInSafeStop, kStaysInFault},
    {"off route", [](ModeInputs& i) { i.near_route = false; }, kComesUp, kStaysInStandby, kStaysInActive,
     kStaysInSafeStop, kStaysInFault},
    {"route end", [](ModeInputs& i) { i.route_end = true; }, kComesUp, kStaysInStandby,
     Stops(Cause::kRouteEnd), kStaysInSafeStop, kStaysInFault},
    {"plan exhausted", [](ModeInputs& i) { i.plan_usable = false; }, kComesUp, kStaysInStandby,
     Stops(Cause::kPlanExhausted), kStaysInSafeStop, kStaysInFault},
    {"standstill",
     [](ModeInputs& i) { i.standstill = true; },
     kComesUp,
     kStaysInStandby,
     kStaysInActive,
     {Mode::kStandby, Cause::kStandstill},
     kStaysInFault},
    {"silence",
     [](ModeInputs& i) { i.silent = true; },
     kComesUp,
     kStaysInStandby,
     {Mode::kFault, Cause::kSilent},
     {Mode::kFault, Cause::kSilent},
     kStaysInFault},
    {"silence, bus down",
     [](ModeInputs& i) {
       i.silent = true;
       i.bus_up = false;
     },
     kStaysInInit,
     kStaysInStandby,
     {Mode::kFault, Cause::kBusDown},
     {Mode::kFault, Cause::kBusDown},
     kStaysInFault},
    {"timer cycle", [](ModeInputs& i) { i.state_new = false; }, kComesUp, kStaysInStandby, kStaysInActive,
     kStaysInSafeStop, kStaysInFault},
    {"internal error", [](ModeInputs& i) { i.internal_error = true; }, kFails, kFails, kFails, kFails,
     kStaysInFault},
};

TEST(ModeMachine, EveryModeAnswersEveryEventAsTheTableSays) {
  for (const Row& row : kTable) {
    ModeInputs inputs = Well();
    row.happens(inputs);
    for (const auto& [before, to] :
         {std::pair(Mode::kInit, row.init), std::pair(Mode::kStandby, row.standby),
          std::pair(Mode::kActive, row.active), std::pair(Mode::kSafeStop, row.safe_stop),
          std::pair(Mode::kFault, row.fault)}) {
      const ModeState after = Next(In(before), inputs);
      EXPECT_EQ(after.mode, to.mode) << Name(before) << ", " << row.event << ": " << Name(after.mode);
      EXPECT_EQ(after.cause, to.cause) << Name(before) << ", " << row.event << ": " << Name(after.cause);
    }
  }
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
      {"route", [](ModeInputs& i) { i.route_end = true; }},
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

TEST(ModeMachine, OnlyActiveAndSafeStopCommand) {
  EXPECT_TRUE(Commands(Mode::kActive));
  EXPECT_TRUE(Commands(Mode::kSafeStop));
  for (const Mode mode : {Mode::kInit, Mode::kStandby, Mode::kDegraded, Mode::kFault}) {
    EXPECT_FALSE(Commands(mode));
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
  EXPECT_EQ(FaultOf(Cause::kSilent), dbc::FaultCode::kInternalError);
  EXPECT_EQ(FaultOf(Cause::kInternalError), dbc::FaultCode::kInternalError);
  for (const Cause event : {Cause::kStart, Cause::kInputsHealthy, Cause::kEngaged, Cause::kReleased,
                            Cause::kOverride, Cause::kStandstill, Cause::kRecovered}) {
    EXPECT_EQ(FaultOf(event), dbc::FaultCode::kNone) << Name(event);
  }
}

}  // namespace
}  // namespace lpvmpcd
