// Maps the members of the typed messages to signals. Apart from those of the end-to-end protection (vehicle_bus.hpp),
// the names of vehicle.dbc appear in C++ only here.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <type_traits>

#include "bus/messages.hpp"

namespace bus {

template <typename Struct, typename Member>
struct Field {
  const char* signal;
  Member Struct::*member;

  constexpr Field(const char* signal_name, Member Struct::*member_pointer)
      : signal(signal_name), member(member_pointer) {}
};

template <typename... Members>
struct Fields {
  const char* message;
  std::tuple<Members...> fields;

  explicit constexpr Fields(const char* message_name, Members... members)
      : message(message_name), fields(members...) {}
};

template <typename Struct>
inline constexpr auto kFields = nullptr;

template <>
inline constexpr auto kFields<VehiclePose> =
    Fields("VehiclePose", Field{"X", &VehiclePose::X}, Field{"Y", &VehiclePose::Y});
template <>
inline constexpr auto kFields<VehicleMotion> =
    Fields("VehicleMotion", Field{"Upsilon", &VehicleMotion::upsilon}, Field{"Nu", &VehicleMotion::nu},
           Field{"Omega", &VehicleMotion::omega});
template <>
inline constexpr auto kFields<VehicleFeedback> =
    Fields("VehicleFeedback", Field{"Psi", &VehicleFeedback::psi}, Field{"Delta", &VehicleFeedback::delta},
           Field{"Acceleration", &VehicleFeedback::acceleration});
template <>
inline constexpr auto kFields<ObstaclePosition> =
    Fields("ObstacleObject", Field{"ObjectId", &ObstaclePosition::object_id},
           Field{"X", &ObstaclePosition::X}, Field{"Y", &ObstaclePosition::Y});
template <>
inline constexpr auto kFields<ObstacleShape> =
    Fields("ObstacleObject", Field{"ObjectId", &ObstacleShape::object_id},
           Field{"SemiAxisX", &ObstacleShape::semi_axis_x}, Field{"SemiAxisY", &ObstacleShape::semi_axis_y},
           Field{"Heading", &ObstacleShape::heading}, Field{"PassingSide", &ObstacleShape::passing_side},
           Field{"Shape", &ObstacleShape::outline});
template <>
inline constexpr auto kFields<ObstacleMotion> =
    Fields("ObstacleObject", Field{"ObjectId", &ObstacleMotion::object_id},
           Field{"VelocityX", &ObstacleMotion::velocity_X}, Field{"VelocityY", &ObstacleMotion::velocity_Y},
           Field{"Class", &ObstacleMotion::object_class});
template <>
inline constexpr auto kFields<ObstacleList> = Fields("ObstacleList", Field{"Count", &ObstacleList::count});
template <>
inline constexpr auto kFields<DriverRequest> =
    Fields("DriverRequest", Field{"Engage", &DriverRequest::engage}, Field{"Brake", &DriverRequest::brake},
           Field{"SteeringOverride", &DriverRequest::steering_override});
template <>
inline constexpr auto kFields<SteeringCommand> =
    Fields("SteeringCommand", Field{"Enable", &SteeringCommand::enable},
           Field{"Mode", &SteeringCommand::mode}, Field{"StateCounter", &SteeringCommand::state_counter},
           Field{"PlanAge", &SteeringCommand::plan_age}, Field{"Delta", &SteeringCommand::delta});
template <>
inline constexpr auto kFields<AccelerationCommand> = Fields(
    "AccelerationCommand", Field{"Enable", &AccelerationCommand::enable},
    Field{"Mode", &AccelerationCommand::mode}, Field{"StateCounter", &AccelerationCommand::state_counter},
    Field{"PlanAge", &AccelerationCommand::plan_age},
    Field{"Acceleration", &AccelerationCommand::acceleration});
template <>
inline constexpr auto kFields<ControllerStatus> = Fields(
    "ControllerStatus", Field{"Mode", &ControllerStatus::mode},
    Field{"FaultCode", &ControllerStatus::fault_code},
    Field{"SolverStatus", &ControllerStatus::solver_status},
    Field{"Iterations", &ControllerStatus::iterations}, Field{"SolveTime", &ControllerStatus::solve_time},
    Field{"DeadlineMisses", &ControllerStatus::deadline_misses});
template <>
inline constexpr auto kFields<SchedulingHealth> =
    Fields("SchedulingHealth", Field{"SchedulingError", &SchedulingHealth::scheduling_error},
           Field{"ActiveRows", &SchedulingHealth::active_rows},
           Field{"LargestSlack", &SchedulingHealth::largest_slack});
template <>
inline constexpr auto kFields<HorizonHeader> =
    Fields("PlannedHorizon", Field{"Points", &HorizonHeader::points},
           Field{"StateCounter", &HorizonHeader::state_counter}, Field{"Step", &HorizonHeader::step});
template <>
inline constexpr auto kFields<HorizonPoint> =
    Fields("PlannedHorizon", Field{"Index", &HorizonPoint::index}, Field{"X", &HorizonPoint::X},
           Field{"Y", &HorizonPoint::Y});
template <>
inline constexpr auto kFields<ControllerDiagnostics> =
    Fields("ControllerDiagnostics", Field{"Cause", &ControllerDiagnostics::cause},
           Field{"PreviousMode", &ControllerDiagnostics::previous_mode},
           Field{"Countdown", &ControllerDiagnostics::countdown},
           Field{"FaultyMessage", &ControllerDiagnostics::faulty_message},
           Field{"FrameFault", &ControllerDiagnostics::frame_fault},
           Field{"CycleLatency", &ControllerDiagnostics::cycle_latency},
           Field{"PlansRefused", &ControllerDiagnostics::plans_refused});
template <>
inline constexpr auto kFields<ConstraintReport> =
    Fields("ConstraintReport", Field{"Verdict", &ConstraintReport::verdict},
           Field{"Constraint", &ConstraintReport::constraint}, Field{"Index", &ConstraintReport::index},
           Field{"Step", &ConstraintReport::step}, Field{"Amount", &ConstraintReport::amount});
template <>
inline constexpr auto kFields<DisturbanceEstimate> =
    Fields("DisturbanceEstimate", Field{"SteeringOffset", &DisturbanceEstimate::steering_offset},
           Field{"LateralAcceleration", &DisturbanceEstimate::lateral_acceleration},
           Field{"LongitudinalAcceleration", &DisturbanceEstimate::longitudinal_acceleration},
           Field{"StiffnessFactor", &DisturbanceEstimate::stiffness_factor},
           Field{"Grip", &DisturbanceEstimate::grip});
template <>
inline constexpr auto kFields<ManoeuvreStatus> =
    Fields("ManoeuvreStatus", Field{"Decision", &ManoeuvreStatus::decision},
           Field{"Reason", &ManoeuvreStatus::reason}, Field{"ObjectId", &ManoeuvreStatus::object_id},
           Field{"Side", &ManoeuvreStatus::side}, Field{"LeftOut", &ManoeuvreStatus::left_out},
           Field{"StopDistance", &ManoeuvreStatus::stop_distance},
           Field{"SpeedLimit", &ManoeuvreStatus::speed_limit});

// The last enumerator of each enumeration; all enumerations begin at 0 and have no gaps.
inline constexpr ConstraintVerdict LastOf(ConstraintVerdict) {
  return ConstraintVerdict::kRejected;
}
inline constexpr ConstraintName LastOf(ConstraintName) {
  return ConstraintName::kTrust;
}
inline constexpr ManoeuvreDecision LastOf(ManoeuvreDecision) {
  return ManoeuvreDecision::kSqueeze;
}
inline constexpr ManoeuvreReason LastOf(ManoeuvreReason) {
  return ManoeuvreReason::kNoWay;
}
inline constexpr PassingSide LastOf(PassingSide) {
  return PassingSide::kRight;
}
inline constexpr Outline LastOf(Outline) {
  return Outline::kBox;
}
inline constexpr ObstacleClass LastOf(ObstacleClass) {
  return ObstacleClass::kPedestrian;
}
inline constexpr Mode LastOf(Mode) {
  return Mode::kFault;
}
inline constexpr SolverStatus LastOf(SolverStatus) {
  return SolverStatus::kNumericalFailure;
}
inline constexpr FaultCode LastOf(FaultCode) {
  return FaultCode::kPlanRejected;
}
inline constexpr ModeCause LastOf(ModeCause) {
  return ModeCause::kStopDue;
}

// Conversion of a member to the physical value of its signal, and back; false if the member cannot hold the value.
template <typename Member>
[[nodiscard]] double ToPhysical(Member member) {
  return static_cast<double>(member);
}

template <typename Member>
[[nodiscard]] bool FromPhysical(double value, Member& member) {
  if constexpr (std::is_floating_point_v<Member>) {
    if (!std::isfinite(value)) return false;
    member = value;
  } else {
    double last = 0.0;
    if constexpr (std::is_enum_v<Member>) {
      last = static_cast<double>(LastOf(Member{}));
    } else {
      last = static_cast<double>(std::numeric_limits<Member>::max());
    }
    if (!(value >= 0.0 && value <= last && value == std::floor(value))) return false;
    member = static_cast<Member>(static_cast<int>(value));
  }
  return true;
}

}  // namespace bus
