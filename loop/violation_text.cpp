#include "loop/violation_text.hpp"

#include <array>
#include <cstddef>
#include <fmt/format.h>
#include <string_view>

namespace loop {
namespace {

using control::ConstraintKind;

constexpr std::array kStateNames{"X", "Y", "upsilon", "nu", "psi", "omega"};
constexpr std::array kStateUnits{"m", "m", "m/s", "m/s", "rad", "rad/s"};
constexpr std::array kInputNames{"delta", "a"};
constexpr std::array kInputUnits{"rad", "m/s^2"};

}  // namespace

std::string ViolationText(const control::ConstraintViolation& violation) {
  const auto& [constraint, amount] = violation;
  const auto index = static_cast<std::size_t>(constraint.index);
  const auto at = [&](const std::string& what, std::string_view unit) {
    const bool small = unit == "m" && amount < 0.1;
    const std::string lacking =
        small ? fmt::format("{:.1f} mm", 1e3 * amount) : fmt::format("{:.2f} {}", amount, unit);
    return fmt::format("{} at i = {}, short of {}", what, constraint.step, lacking);
  };
  switch (constraint.kind) {
    case ConstraintKind::kInput:
      return at(fmt::format("bound of {}", kInputNames.at(index)), kInputUnits.at(index));
    case ConstraintKind::kRate:
      return at(fmt::format("rate of {}", kInputNames.at(index)), kInputUnits.at(index));
    case ConstraintKind::kState:
      return at(fmt::format("bound of {}", kStateNames.at(index)), kStateUnits.at(index));
    case ConstraintKind::kRoad:
      return at("road", "m");
    case ConstraintKind::kObstacle:
      return at(fmt::format("obstacle {}", constraint.index), "m");
    case ConstraintKind::kFriction:
      return at(constraint.index == 0 ? "friction across" : "friction", "m/s^2");
    case ConstraintKind::kTrust:
      return at("trust region", "");
    case ConstraintKind::kModel:
      break;
  }
  return at(fmt::format("model of {}", kStateNames.at(index)), kStateUnits.at(index));
}

}  // namespace loop
