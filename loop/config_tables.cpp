#include "loop/config_tables.hpp"

#include "loop/controller_tables.hpp"
#include "loop/service_tables.hpp"

namespace loop {
namespace {

constexpr Reload kIdle = Reload::kWhileNotCommanding;

ConfigTable MonitorTable() {
  return {"monitor",
          "",
          {
              Key(
                  "stale_periods", [](Config& c) { return &c.loop.monitor.stale_periods; }, {1.0, 1000.0, ""},
                  "Age, in its periods, above which a message is stale", kIdle),
              Key(
                  "max_lost", [](Config& c) { return &c.loop.monitor.max_lost; }, {0, 13, ""},
                  "Number of frames that may be missing between two accepted ones", kIdle),
              Key(
                  "max_state_gap", [](Config& c) { return &c.loop.monitor.max_state_gap; }, {0.0, 0.5, "s"},
                  "Age of the vehicle's state up to which its model bridges a gap; beyond it, and beyond "
                  "_stale_periods_, the vehicle is stopped",
                  kIdle),
          }};
}

ConfigTable EngageTable() {
  return {
      "engage",
      "",
      {
          OptionalKey(
              "min_speed", [](Config& c) { return &c.engage_min_speed; }, {0.0, 50.0, "m/s"},
              "0, or 3 with the paper's controllers", "Lowest speed at which the driver's request is granted",
              kIdle),
          Key(
              "max_heading_error", [](Config& c) { return &c.loop.engage_max_heading_error; },
              {0.0, 3.15, "rad"}, "Largest heading error at which the driver's request is granted", kIdle),
      }};
}

ConfigTable DegradedTable() {
  return {"degraded",
          "",
          {Key(
              "max_time", [](Config& c) { return &c.degraded_time; }, {0.0, 10.0, "s"},
              "Time for which the daemon drives on without a new plan, the obstacles or the driver's "
              "request, before it "
              "stops the vehicle",
              kIdle)}};
}

ConfigTable SafeStopTable() {
  return {"safe_stop",
          "",
          {
              Key(
                  "deceleration", [](Config& c) { return &c.loop.stop_deceleration; }, {0.1, 10.0, "m/s^2"},
                  "Deceleration of a controlled stop; not above the strongest braking of "
                  "_limits.min_acceleration_",
                  kIdle),
              Key(
                  "standstill_speed", [](Config& c) { return &c.loop.standstill_speed; }, {0.01, 5.0, "m/s"},
                  "Speed below which the vehicle stands", kIdle),
              Key(
                  "hold_time", [](Config& c) { return &c.hold_time; }, {0.0, 60.0, "s"},
                  "Time for which the vehicle is held at standstill, and drives on if the cause of the stop "
                  "is gone, before the driver has to ask again",
                  kIdle),
          }};
}

ConfigTable LimitsTable() {
  return {"limits",
          "They bound the optimal control problem, and the limiter after it.",
          {
              Key(
                  "max_steering", [](Config& c) { return &c.loop.limits.max_steering; }, {0.01, 1.04, "rad"},
                  "Largest steering angle"),
              Key(
                  "max_steering_step", [](Config& c) { return &c.loop.limits.max_steering_step; },
                  {0.001, 2.0, "rad"}, "Largest change of the steering angle from one command to the next"),
              Key(
                  "min_acceleration", [](Config& c) { return &c.loop.limits.min_acceleration; },
                  {-13.0, -0.1, "m/s^2"}, "Strongest braking"),
              Key(
                  "max_acceleration", [](Config& c) { return &c.loop.limits.max_acceleration; },
                  {0.0, 13.0, "m/s^2"}, "Largest acceleration"),
              Key(
                  "max_acceleration_step", [](Config& c) { return &c.loop.limits.max_acceleration_step; },
                  {0.01, 20.0, "m/s^2"}, "Largest change of acceleration from one command to the next"),
          }};
}

ConfigTable StatusTable() {
  return {"status",
          "",
          {Key(
              "horizon", [](Config& c) { return &c.loop.send_horizon; }, {},
              "Whether the planned horizon is sent", kIdle)}};
}

}  // namespace

std::vector<ConfigTable> ConfigTables() {
  return {BusTable(),      RouteTable(),    CycleTable(),  MonitorTable(),    EngageTable(),
          DegradedTable(), SafeStopTable(), LimitsTable(), ControllerTable(), LpvAffineTable(),
          VehicleTable(),  StatusTable(),   LogTable(),    RealTimeTable()};
}

Reload ReloadOf(std::string_view key) {
  for (const ConfigTable& table : ConfigTables()) {
    for (const ConfigKey& entry : table.keys) {
      if (key == table.name + "." + entry.name) return entry.reload;
    }
  }
  return Reload::kNeedsRestart;
}

}  // namespace loop
