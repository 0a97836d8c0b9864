#include "safety/mode_machine.hpp"

#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "bus/names.hpp"

namespace safety {
namespace {

// Inputs without any fault, with engage requested.
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

// A state in `mode`, healthy for long enough and with five cycles left for Degraded.
ModeState In(bus::Mode mode, bool armed = false) {
  return {.mode = mode,
          .cause = Cause::kStart,
          .healthy_cycles = kHealthyCycles,
          .armed = armed,
          .degraded_left = 5};
}

struct Row {
  std::string event;
  std::function<void(ModeInputs&)> happens;
  // Mode after one cycle, and the cause if the mode changes; one member per mode before.
  struct To {
    bus::Mode mode;
    Cause cause = Cause::kStart;
  };
  To init, standby, active, degraded, safe_stop, fault;
};

const Row::To kStaysInInit{bus::Mode::kInit};
const Row::To kStaysInStandby{bus::Mode::kStandby};
const Row::To kStaysInActive{bus::Mode::kActive};
const Row::To kStaysInDegraded{bus::Mode::kDegraded};
const Row::To kStaysInSafeStop{bus::Mode::kSafeStop};
const Row::To kStaysInFault{bus::Mode::kFault};
const Row::To kComesUp{bus::Mode::kStandby, Cause::kInputsHealthy};
const Row::To kGoesOn{bus::Mode::kActive, Cause::kRecovered};
const Row::To kRecovers{bus::Mode::kStandby, Cause::kRecovered};
const Row::To kYields{bus::Mode::kStandby, Cause::kOverride};
const Row::To kLetsGo{bus::Mode::kStandby, Cause::kReleased};
const Row::To kFails{bus::Mode::kFault, Cause::kInternalError};

Row::To Degrades(Cause cause) {
  return {bus::Mode::kDegraded, cause};
}
Row::To Stops(Cause cause) {
  return {bus::Mode::kSafeStop, cause};
}
Row::To Gives(Cause cause) {
  return {bus::Mode::kFault, cause};
}

// One row per event, one column per mode. Standby is not armed here: edges have their own tests.
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
    {"stop due", [](ModeInputs& i) { i.stop_due = true; },
     kComesUp, kStaysInStandby, Stops(Cause::kStopDue), Stops(Cause::kStopDue), kStaysInSafeStop, kStaysInFault},
    {"plan exhausted", [](ModeInputs& i) { i.plan_fault = Cause::kSolverFailed; i.plan_usable = false; },
     kComesUp, kStaysInStandby, Stops(Cause::kPlanExhausted), Stops(Cause::kPlanExhausted), kStaysInSafeStop,
     kStaysInFault},
    {"off route", [](ModeInputs& i) { i.near_route = false; },
     kComesUp, kStaysInStandby, kStaysInActive, kGoesOn, kStaysInSafeStop, kStaysInFault},
    {"route end", [](ModeInputs& i) { i.route_left = 0; },
     kComesUp, kStaysInStandby, Stops(Cause::kRouteEnd), Stops(Cause::kRouteEnd), kStaysInSafeStop, kStaysInFault},
    {"standstill", [](ModeInputs& i) { i.standstill = true; },
     kComesUp, kStaysInStandby, kStaysInActive, kGoesOn, kStaysInSafeStop, kStaysInFault},
    {"silence", [](ModeInputs& i) { i.silent = true; },
     kComesUp, kStaysInStandby, Gives(Cause::kSilent), Gives(Cause::kSilent), Gives(Cause::kSilent), kStaysInFault},
    {"silence, bus down", [](ModeInputs& i) { i.silent = true; i.bus_up = false; },
     kStaysInInit, kStaysInStandby, Gives(Cause::kBusDown), Gives(Cause::kBusDown), Gives(Cause::kBusDown),
     kStaysInFault},
    {"timer cycle", [](ModeInputs& i) { i.state_new = false; },
     kComesUp, kStaysInStandby, kStaysInActive, kGoesOn, kStaysInSafeStop, kStaysInFault},
    {"internal error", [](ModeInputs& i) { i.internal_error = true; },
     kFails, kFails, kFails, kFails, kFails, kStaysInFault},
    // An override takes precedence over all other events.
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
         {std::pair(bus::Mode::kInit, row.init), std::pair(bus::Mode::kStandby, row.standby),
          std::pair(bus::Mode::kActive, row.active), std::pair(bus::Mode::kDegraded, row.degraded),
          std::pair(bus::Mode::kSafeStop, row.safe_stop), std::pair(bus::Mode::kFault, row.fault)}) {
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
  ModeState state = In(bus::Mode::kActive);
  for (const int left : {2, 1, 0}) {
    state = Next(state, inputs, settings);
    EXPECT_EQ(state.mode, bus::Mode::kDegraded);
    EXPECT_EQ(state.degraded_left, left);
  }
  inputs.obstacles_fresh = true;
  inputs.plan_fault = Cause::kDeadlineMissed;  // another fault now; the count goes on
  state = Next(state, inputs, settings);
  EXPECT_EQ(state.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(state.cause, Cause::kDeadlineMissed);
}

TEST(ModeMachine, AfterRecoveryTheCountBeginsAnew) {
  const ModeSettings settings{.degraded_cycles = 2};
  ModeInputs stale = Well();
  stale.request_fresh = false;
  ModeState state = Next(Next(In(bus::Mode::kActive), stale, settings), Well(), settings);
  EXPECT_EQ(state.mode, bus::Mode::kActive);
  state = Next(Next(state, stale, settings), stale, settings);
  EXPECT_EQ(state.mode, bus::Mode::kDegraded);
  EXPECT_EQ(Next(state, stale, settings).mode, bus::Mode::kSafeStop);
}

TEST(ModeMachine, WithNoTimeToSpendInDegradedItStopsAtOnce) {
  ModeInputs inputs = Well();
  inputs.plan_fault = Cause::kSolverFailed;
  const ModeState state = Next(In(bus::Mode::kActive), inputs, {.degraded_cycles = 0});
  EXPECT_EQ(state.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(state.cause, Cause::kSolverFailed);
}

TEST(ModeMachine, SafeStopIsLeftAfterThreeCyclesInARowWithoutACause) {
  ModeInputs good = Well();
  good.plan_new = true;
  const std::vector<std::pair<std::string, std::function<void(ModeInputs&)>>> causes = {
      {"bus", [](ModeInputs& i) { i.bus_up = false; }},
      {"state", [](ModeInputs& i) { i.state_fresh = false; }},
      {"late state", [](ModeInputs& i) { i.plan_fault = Cause::kStateLate; }},
      {"obstacles", [](ModeInputs& i) { i.obstacles_fresh = false; }},
      {"request", [](ModeInputs& i) { i.request_fresh = false; }},
      {"route", [](ModeInputs& i) { i.route_left = 0; }},
      {"plan", [](ModeInputs& i) { i.plan_new = false; }}};
  for (const bool standstill : {false, true}) {
    good.standstill = standstill;
    for (const auto& [name, happens] : causes) {
      ModeInputs bad = good;
      happens(bad);
      if (standstill && bad.route_left <= 0) continue;  // the vehicle has arrived
      ModeState state = Next(Next(In(bus::Mode::kSafeStop), good), good);
      EXPECT_EQ(state.mode, bus::Mode::kSafeStop);
      state = Next(Next(Next(state, bad), good), good);
      EXPECT_EQ(state.mode, bus::Mode::kSafeStop) << name;
      state = Next(state, good);
      EXPECT_EQ(state.mode, bus::Mode::kActive) << name;
      EXPECT_EQ(state.cause, Cause::kRecovered);
      EXPECT_EQ(state.previous, bus::Mode::kSafeStop);
    }
  }
}

TEST(ModeMachine, OneStepOfRouteIsEnoughToDriveOnFromAStop) {
  ModeInputs inputs = Well();
  inputs.plan_new = true;
  inputs.standstill = true;
  inputs.route_left = 1;
  EXPECT_EQ(Next(In(bus::Mode::kActive), inputs).mode, bus::Mode::kActive);
  ModeState state = Next(Next(In(bus::Mode::kSafeStop), inputs), inputs);
  EXPECT_EQ(state.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(Next(state, inputs).mode, bus::Mode::kActive);
}

TEST(ModeMachine, EachStopCountsItsCyclesFromTheBeginning) {
  ModeInputs fails = Well();
  fails.plan_usable = false;
  ModeInputs good = Well();
  good.plan_new = true;
  const ModeState stopped = Next(In(bus::Mode::kActive), fails);
  ASSERT_EQ(stopped.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(stopped.recovered_cycles, 0);
  EXPECT_EQ(stopped.standing_cycles, 0);
  const ModeState almost = Next(Next(stopped, good), good);
  EXPECT_EQ(almost.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(Next(almost, good).mode, bus::Mode::kActive);
}

TEST(ModeMachine, SafeStopHoldsTheVehicleAtStandstillForAWhile) {
  ModeInputs stands = Well();
  stands.standstill = true;
  ModeInputs moves = Well();
  const ModeSettings settings{.hold_cycles = 3};
  ModeState state = In(bus::Mode::kSafeStop);
  for (int i = 0; i < 3; ++i) state = Next(state, stands, settings);
  state = Next(state, moves, settings);  // on a slope, say: the count begins anew
  for (int i = 0; i < 3; ++i) {
    state = Next(state, stands, settings);
    EXPECT_EQ(state.mode, bus::Mode::kSafeStop);
  }
  state = Next(state, stands, settings);
  EXPECT_EQ(state.mode, bus::Mode::kStandby);
  EXPECT_EQ(state.cause, Cause::kStandstill);
  stands.route_left = 0;
  state = Next(In(bus::Mode::kSafeStop), stands, settings);
  EXPECT_EQ(state.mode, bus::Mode::kStandby);
  EXPECT_EQ(state.cause, Cause::kRouteEnd);
}

TEST(ModeMachine, InitIsLeftAfterThreeHealthyCyclesInARow) {
  ModeState state;
  ModeInputs inputs = Well();
  inputs.engage = false;
  state = Next(Next(state, inputs), inputs);
  EXPECT_EQ(state.mode, bus::Mode::kInit);
  inputs.obstacles_fresh = false;
  state = Next(state, inputs);
  inputs.obstacles_fresh = true;
  state = Next(Next(state, inputs), inputs);
  EXPECT_EQ(state.mode, bus::Mode::kInit);
  state = Next(state, inputs);
  EXPECT_EQ(state.mode, bus::Mode::kStandby);
}

TEST(ModeMachine, RequestHeldFromTheStartDoesNotEngage) {
  ModeState state;
  for (int i = 0; i < 20; ++i) {
    state = Next(state, Well());
  }
  EXPECT_EQ(state.mode, bus::Mode::kStandby);
}

TEST(ModeMachine, RisingEdgeSeenInStandbyEngages) {
  ModeInputs inputs = Well();
  inputs.engage = false;
  ModeState state = Next(In(bus::Mode::kStandby), inputs);
  EXPECT_EQ(state.mode, bus::Mode::kStandby);
  inputs.engage = true;
  EXPECT_TRUE(EngagementRequested(state, inputs));
  state = Next(state, inputs);
  EXPECT_EQ(state.mode, bus::Mode::kActive);
  EXPECT_EQ(state.cause, Cause::kEngaged);
}

TEST(ModeMachine, EdgeBetweenTwoCyclesEngages) {
  ModeInputs inputs = Well();
  inputs.released = true;
  EXPECT_EQ(Next(In(bus::Mode::kStandby), inputs).mode, bus::Mode::kActive);
}

TEST(ModeMachine, ReleaseBetweenTwoCyclesEndsActive) {
  ModeInputs inputs = Well();
  inputs.released = true;
  EXPECT_EQ(Next(In(bus::Mode::kActive), inputs).mode, bus::Mode::kStandby);
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
    ModeState state = Next(In(bus::Mode::kStandby, true), inputs);
    EXPECT_EQ(state.mode, bus::Mode::kStandby) << name;
    for (int i = 0; i < 5; ++i) {
      state = Next(state, Well());
      EXPECT_EQ(state.mode, bus::Mode::kStandby) << name;
    }
  }
}

TEST(ModeMachine, EdgeInATimerCycleWaitsForTheNextState) {
  ModeInputs inputs = Well();
  inputs.state_new = false;
  const ModeState state = Next(In(bus::Mode::kStandby, true), inputs);
  EXPECT_EQ(state.mode, bus::Mode::kStandby);
  EXPECT_EQ(Next(state, Well()).mode, bus::Mode::kActive);
}

TEST(ModeMachine, EdgeInATimerCycleIsSpentByAnOverride) {
  ModeInputs inputs = Well();
  inputs.state_new = false;
  inputs.override_seen = true;
  const ModeState state = Next(In(bus::Mode::kStandby, true), inputs);
  EXPECT_EQ(Next(state, Well()).mode, bus::Mode::kStandby);
}

TEST(ModeMachine, AfterAnOverrideTheDriverHasToAskAgain) {
  ModeInputs inputs = Well();
  inputs.override_seen = true;
  ModeState state = Next(In(bus::Mode::kActive), inputs);
  EXPECT_EQ(state.mode, bus::Mode::kStandby);
  state = Next(Next(state, Well()), Well());
  EXPECT_EQ(state.mode, bus::Mode::kStandby);
}

TEST(ModeMachine, OnlyActiveDegradedAndSafeStopCommand) {
  for (const bus::Mode mode : {bus::Mode::kActive, bus::Mode::kDegraded, bus::Mode::kSafeStop}) {
    EXPECT_TRUE(bus::Commands(mode));
    EXPECT_EQ(bus::Drives(mode), mode != bus::Mode::kSafeStop);
  }
  for (const bus::Mode mode : {bus::Mode::kInit, bus::Mode::kStandby, bus::Mode::kFault}) {
    EXPECT_FALSE(bus::Commands(mode));
    EXPECT_FALSE(bus::Drives(mode));
  }
}

TEST(ModeMachine, EngagementIsRequestedInStandbyAlone) {
  EXPECT_TRUE(EngagementRequested(In(bus::Mode::kStandby, true), Well()));
  for (const bus::Mode mode : {bus::Mode::kInit, bus::Mode::kActive, bus::Mode::kDegraded,
                               bus::Mode::kSafeStop, bus::Mode::kFault}) {
    EXPECT_FALSE(EngagementRequested(In(mode, true), Well())) << bus::Name(mode);
  }
}

TEST(ModeMachine, InputsThatWereHealthyForTooShortDoNotEngage) {
  ModeState standby = In(bus::Mode::kStandby, true);
  standby.healthy_cycles = kHealthyCycles - 1;
  EXPECT_TRUE(EngagementRequested(standby, Well()));
  standby.healthy_cycles = kHealthyCycles - 2;
  EXPECT_FALSE(EngagementRequested(standby, Well()));
}

TEST(ModeMachine, OneStepOfRouteLeftIsEnoughToEngageAndToDriveOn) {
  ModeInputs inputs = Well();
  inputs.route_left = 1;
  EXPECT_EQ(Next(In(bus::Mode::kStandby, true), inputs).mode, bus::Mode::kActive);
  EXPECT_EQ(Next(In(bus::Mode::kActive), inputs).mode, bus::Mode::kActive);
  inputs.route_left = 0;
  EXPECT_FALSE(EngagementRequested(In(bus::Mode::kStandby, true), inputs));
  EXPECT_EQ(Next(In(bus::Mode::kActive), inputs).mode, bus::Mode::kSafeStop);
  EXPECT_EQ(Next(In(bus::Mode::kActive), inputs).cause, Cause::kRouteEnd);
  inputs.standstill = true;
  EXPECT_EQ(Next(In(bus::Mode::kActive), inputs).mode, bus::Mode::kStandby);
  EXPECT_EQ(Next(In(bus::Mode::kActive), inputs).cause, Cause::kRouteEnd);
}

TEST(ModeMachine, FaultsHaveACodeAndEventsHaveNone) {
  EXPECT_EQ(FaultOf(Cause::kBusDown), bus::FaultCode::kBusDown);
  EXPECT_EQ(FaultOf(Cause::kStateStale), bus::FaultCode::kStateStale);
  EXPECT_EQ(FaultOf(Cause::kStateInvalid), bus::FaultCode::kStateInvalid);
  EXPECT_EQ(FaultOf(Cause::kObstaclesStale), bus::FaultCode::kObstaclesStale);
  EXPECT_EQ(FaultOf(Cause::kDriverRequestStale), bus::FaultCode::kDriverRequestStale);
  EXPECT_EQ(FaultOf(Cause::kRouteEnd), bus::FaultCode::kRouteEnd);
  EXPECT_EQ(FaultOf(Cause::kPlanExhausted), bus::FaultCode::kPlanExhausted);
  EXPECT_EQ(FaultOf(Cause::kStateLate), bus::FaultCode::kStateLate);
  EXPECT_EQ(FaultOf(Cause::kDeadlineMissed), bus::FaultCode::kDeadlineMissed);
  EXPECT_EQ(FaultOf(Cause::kPlanRejected), bus::FaultCode::kPlanRejected);
  EXPECT_EQ(FaultOf(Cause::kSilent), bus::FaultCode::kInternalError);
  EXPECT_EQ(FaultOf(Cause::kInternalError), bus::FaultCode::kInternalError);
  for (const Cause event : {Cause::kStart, Cause::kInputsHealthy, Cause::kEngaged, Cause::kReleased,
                            Cause::kOverride, Cause::kStandstill, Cause::kRecovered}) {
    EXPECT_EQ(FaultOf(event), bus::FaultCode::kNone) << Name(event);
  }
}

}  // namespace
}  // namespace safety
