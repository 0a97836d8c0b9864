// What the vehicle and one object mean for each other, in road coordinates.
#pragma once

#include <optional>

#include "sim/road_body.hpp"

namespace sim {

// Time until the vehicle reaches an object that is ahead and covers offsets that the vehicle covers, if both keep their
// speed along the road [s]; none if the object is beside or behind the vehicle, or gets no nearer.
[[nodiscard]] inline std::optional<double> TimeToCollision(const RoadBody& vehicle, const RoadBody& object) {
  const double gap = object.rear - vehicle.front, closing = vehicle.speed - object.speed;
  if (!InSameLane(vehicle, object) || gap <= 0.0 || closing <= 0.0) return std::nullopt;
  return gap / closing;
}

enum class ContactFault { kOurs, kTheirs };

// Whose fault a contact is, judged when it begins: theirs if the vehicle stands (`speed` < 0.3 m/s), or if the object ran
// into it from behind.
[[nodiscard]] inline ContactFault FaultOf(double speed, const RoadBody& vehicle, const RoadBody& object) {
  constexpr double kStands = 0.3;  // [m/s]
  const bool from_behind = object.s < vehicle.rear && object.speed > vehicle.speed;
  return speed < kStands || from_behind ? ContactFault::kTheirs : ContactFault::kOurs;
}

}  // namespace sim
