#include "loop/service_tables.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace loop {
namespace {

using config::TomlTable;

void ReadCpus(const TomlTable& table, Config& config) {
  if (!table.Has("cpus")) return;
  for (const double cpu : table.Numbers("cpus", 0, {0.0, 1023.0})) {
    if (cpu != std::floor(cpu)) {
      throw table.Error("cpus", fmt::format("must be whole numbers, not {}", cpu));
    }
    config.service.real_time.cpus.push_back(static_cast<int>(cpu));
  }
}

}  // namespace

ConfigTable BusTable() {
  return {
      "bus",
      "",
      {
          {.name = "interface",
           .default_value = fmt::format("\"{}\"", ServiceSettings().interface),
           .allowed = "",
           .sentence = "CAN interface. The option *--interface*, which the unit gives, takes precedence",
           .read = [](const TomlTable& table,
                      Config& c) { c.service.interface = table.TextOr("interface", c.service.interface); }},
          {.name = "dbc",
           .default_value = "\"FILE\"",
           .allowed = "",
           .sentence = "DBC file with another definition of the daemon's messages. Without it the built-in "
                       "one holds, "
                       "/usr/share/lpvmpcd/vehicle.dbc",
           .read =
               [](const TomlTable& table, Config& c) {
                 if (table.Has("dbc")) c.dbc = table.Path("dbc");
               }},
      }};
}

ConfigTable RouteTable() {
  return {"route",
          "",
          {{.name = "file",
            .default_value = "\"FILE\"",
            .allowed = "",
            .sentence = "Route file. Required",
            .read = [](const TomlTable& table, Config& c) { c.route = table.Path("file"); }}}};
}

ConfigTable CycleTable() {
  return {"cycle",
          "",
          {
              Key(
                  "period", [](Config& c) { return &c.loop.period; }, {0.005, 1.0, "s"},
                  "Sampling time of bus, reference and controller"),
              {.name = "deadline",
               .default_value = "period",
               .allowed = "0.001..period s",
               .sentence = "Age at which a state is too old to be answered: no new plan is made of it, and "
                           "the last one is "
                           "followed. In lock step there is no deadline",
               .read =
                   [](const TomlTable& table, Config& c) {
                     const double period = base::ToSeconds(c.loop.period);
                     if (table.Has("deadline")) c.deadline = table.Number("deadline", {0.001, period}, "s");
                   }},
              {.name = "timeout",
               .default_value = "1.5 period",
               .allowed = "period..1.5 s",
               .sentence = "Time after a state at which a cycle runs without a new one",
               .read =
                   [](const TomlTable& table, Config& c) {
                     if (!table.Has("timeout")) return;
                     c.timeout = table.Number("timeout", {0.005, 1.5}, "s");
                     if (*c.timeout < base::ToSeconds(c.loop.period)) {
                       throw table.Error("timeout", "must not be shorter than the period");
                     }
                   }},
              Key(
                  "command_delay", [](Config& c) { return &c.loop.command_delay; }, {0.0, 0.5, "s"},
                  "Time from a command to its effect, by which the measured state is predicted"),
              Key(
                  "lockstep", [](Config& c) { return &c.service.lockstep; }, {},
                  "Time is counted by the vehicle's frames, which makes a drive repeatable. For simulation "
                  "only: it is refused "
                  "on an interface that is not virtual"),
          }};
}

ConfigTable LogTable() {
  const std::vector<std::string> levels{"debug", "info", "warning", "error"};
  return {"log",
          "",
          {ChoiceKey(
              "level", levels,
              [levels](const Config& c) {
                return static_cast<std::size_t>(std::ranges::find(levels, c.log_level) - levels.begin());
              },
              [levels](Config& c, std::size_t i) { c.log_level = levels[i]; },
              "Least severe messages that are logged", Reload::kAlways)}};
}

ConfigTable RealTimeTable() {
  return {"realtime",
          "If the kernel refuses one of these, the daemon runs without it and says so in the log and in the "
          "unit's status.",
          {
              Key(
                  "fifo_priority", [](Config& c) { return &c.service.real_time.fifo_priority; }, {0, 99, ""},
                  "Priority in SCHED_FIFO; 0 is the usual scheduling"),
              Key(
                  "lock_memory", [](Config& c) { return &c.service.real_time.lock_memory; }, {},
                  "Memory is locked and the stack touched, so that there are no page faults. Needs the limit "
                  "RLIMIT_MEMLOCK"),
              {.name = "cpus",
               .default_value = "[]",
               .allowed = "each 0..1023",
               .sentence = "The only processors to run on; none stands for all",
               .read = ReadCpus},
          }};
}

}  // namespace loop
