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

template <typename Enum, std::size_t kCount>
std::string_view NameIn(const std::array<std::string_view, kCount>& names, Enum value) {
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

}  // namespace bus
