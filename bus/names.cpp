#include "bus/names.hpp"

#include <array>
#include <cstddef>

#include "bus/message_fields.hpp"

namespace bus {
namespace {

// Names in the order of the enumerators.
constexpr auto kModes =
    std::to_array<std::string_view>({"Init", "Standby", "Active", "Degraded", "SafeStop", "Fault"});

constexpr auto kFaults = std::to_array<std::string_view>(
    {"no fault", "vehicle state stale", "vehicle state refused", "obstacles stale", "driver request stale",
     "problem infeasible", "solver at its iteration limit", "solver failed numerically", "plan exhausted",
     "end of route", "not on the route or too slow", "bus down", "internal error", "no new vehicle state",
     "deadline missed", "plan rejected"});

constexpr auto kVerdicts = std::to_array<std::string_view>({"met", "relaxed", "unsolved", "rejected"});

constexpr auto kConstraints = std::to_array<std::string_view>(
    {"model", "input", "rate", "state", "road", "obstacle", "friction", "trust"});

// The verb, and the preposition before an object.
struct Verb {
  std::string_view name, preposition;
};
constexpr auto kDecisions = std::to_array<Verb>({{"no decision", ""},
                                                 {"drives", ""},
                                                 {"passes", ""},
                                                 {"follows", ""},
                                                 {"yields", " to"},
                                                 {"waits", " behind"},
                                                 {"squeezes", " past"}});

constexpr auto kReasons = std::to_array<std::string_view>(
    {"no reason", "the way is free", "staying behind would take longer", "it cannot stay behind any more",
     "the way was free until just now", "it is too late to stop", "the road is too narrow",
     "no gap is wide enough", "an oncoming object takes the gap", "an object crosses first",
     "it would not be past in time", "the gaps are too close together for the steering",
     "passing would gain too little", "the way has not been free for long enough",
     "there is no way and no room to stop"});

constexpr auto kSides = std::to_array<std::string_view>({"", " on the left", " on the right"});

template <typename Name, typename Enum, std::size_t kCount>
Name NameIn(const std::array<Name, kCount>& names, Enum value) {
  static_assert(kCount == static_cast<std::size_t>(LastOf(Enum{})) + 1);
  return names.at(static_cast<std::size_t>(value));
}

}  // namespace

std::string_view Name(Mode mode) {
  return NameIn(kModes, mode);
}

std::string_view Name(FaultCode fault) {
  return NameIn(kFaults, fault);
}

std::string_view Name(ConstraintVerdict verdict) {
  return NameIn(kVerdicts, verdict);
}

std::string_view Name(ConstraintName constraint) {
  return NameIn(kConstraints, constraint);
}

std::string_view Name(ManoeuvreReason reason) {
  return NameIn(kReasons, reason);
}

std::string DecisionText(const ManoeuvreStatus& manoeuvre) {
  const Verb verb = NameIn(kDecisions, manoeuvre.decision);
  std::string text(verb.name);
  if (manoeuvre.object_id == ManoeuvreStatus::kNoObject) return text;
  text += verb.preposition;
  text += " object " + std::to_string(manoeuvre.object_id);
  text += NameIn(kSides, manoeuvre.side);
  return text;
}

std::string ManoeuvreText(const ManoeuvreStatus& manoeuvre) {
  std::string text = DecisionText(manoeuvre);
  if (manoeuvre.decision == ManoeuvreDecision::kNone) return text;
  text += ": ";
  text += Name(manoeuvre.reason);
  return text;
}

}  // namespace bus
