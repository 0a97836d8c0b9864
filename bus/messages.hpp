// The messages of this project as physical values in SI units and radians. vehicle.dbc defines their layout on the
// wire; message_fields.hpp maps each struct and member to a message and a signal there.
#pragma once

#include <cstdint>
#include <variant>

namespace bus {

// ---- in: from the vehicle ----
// The three messages of one state set carry the same counter. Order on the bus: pose, motion, feedback.
struct VehiclePose {
  double X = 0.0;  // centre of gravity in the map [m]
  double Y = 0.0;
};
struct VehicleMotion {
  double upsilon = 0.0;  // longitudinal speed [m/s]
  double nu = 0.0;       // lateral speed [m/s]
  double omega = 0.0;    // yaw rate [rad/s]
};
struct VehicleFeedback {
  double psi = 0.0;           // heading, wrapped to [-π, π] to within the resolution [rad]
  double delta = 0.0;         // steering angle of the front wheels [rad]
  double acceleration = 0.0;  // longitudinal acceleration [m/s²]
};

enum class PassingSide : std::uint8_t { kUnknown = 0, kLeft = 1, kRight = 2 };
enum class Outline : std::uint8_t { kEllipse = 0, kBox = 1 };
enum class ObstacleClass : std::uint8_t {
  kUnknown = 0,
  kStatic = 1,
  kVehicle = 2,
  kCycle = 3,
  kPedestrian = 4
};

// An obstacle is sent as three frames of the multiplexed message ObstacleObject, in this order.
struct ObstaclePosition {
  std::uint8_t object_id = 0;  // 0..63
  double X = 0.0;              // centre in the map [m]
  double Y = 0.0;
};
struct ObstacleShape {
  std::uint8_t object_id = 0;
  double semi_axis_x = 0.0;  // semi-axis of an ellipse, half side of a box, along the heading [m]
  double semi_axis_y = 0.0;
  double heading = 0.0;  // wrapped to [-π, π] [rad]
  PassingSide passing_side = PassingSide::kUnknown;
  Outline outline = Outline::kEllipse;
};
struct ObstacleMotion {
  std::uint8_t object_id = 0;
  double velocity_X = 0.0;  // in the map [m/s]
  double velocity_Y = 0.0;
  ObstacleClass object_class = ObstacleClass::kUnknown;
};
// Ends a cycle's obstacle frames: the objects sent since the previous list are all the obstacles.
struct ObstacleList {
  std::uint8_t count = 0;  // 0..64
};

struct DriverRequest {
  bool engage = false;             // held while automatic driving is wanted; engagement needs a rising edge
  bool brake = false;              // the driver brakes: override
  bool steering_override = false;  // the driver steers: override
};

// ---- out: from the controller ----
enum class Mode : std::uint8_t {
  kInit = 0,
  kStandby = 1,
  kActive = 2,
  kDegraded = 3,
  kSafeStop = 4,
  kFault = 5
};

// True in the modes that follow a plan.
[[nodiscard]] constexpr bool Drives(Mode mode) {
  return mode == Mode::kActive || mode == Mode::kDegraded;
}
// True in the modes whose commands the vehicle is to obey.
[[nodiscard]] constexpr bool Commands(Mode mode) {
  return Drives(mode) || mode == Mode::kSafeStop;
}

struct SteeringCommand {
  bool enable = false;
  Mode mode = Mode::kInit;
  std::uint8_t state_counter = 0;  // counter of the answered state set, 15 if none is answered
  std::uint8_t plan_age = 0;       // cycles since the plan behind it was made; 63: 63 or more, or no plan
  double delta = 0.0;              // [rad]
};
struct AccelerationCommand {
  bool enable = false;
  Mode mode = Mode::kInit;
  std::uint8_t state_counter = 0;
  std::uint8_t plan_age = 0;
  double acceleration = 0.0;  // [m/s²]
};

enum class SolverStatus : std::uint8_t {
  kNone = 0,  // no problem was solved in this cycle
  kSolved = 1,
  kInfeasible = 2,
  kIterationLimit = 3,
  kNumericalFailure = 4,
};

enum class FaultCode : std::uint8_t {
  kNone = 0,
  kStateStale = 1,
  kStateInvalid = 2,  // stale because frames of the state's messages are refused
  kObstaclesStale = 3,
  kDriverRequestStale = 4,
  kSolverInfeasible = 5,
  kSolverIterationLimit = 6,
  kSolverNumericalFailure = 7,
  kPlanExhausted = 8,  // the last accepted plan is used up
  kRouteEnd = 9,
  kOffRoute = 10,
  kBusDown = 11,
  kInternalError = 12,
  kStateLate = 13,       // no new state in this cycle
  kDeadlineMissed = 14,  // the plan was too late to be used
  kPlanRejected = 15,    // solved, but must not be followed
};
// Why a mode was entered.
enum class ModeCause : std::uint8_t {
  kStart = 0,
  kInputsHealthy = 1,
  kEngaged = 2,
  kReleased = 3,
  kOverride = 4,
  kStandstill = 5,
  kRecovered = 6,
  kBusDown = 7,
  kStateStale = 8,
  kStateInvalid = 9,
  kObstaclesStale = 10,
  kDriverRequestStale = 11,
  kRouteEnd = 12,
  kPlanExhausted = 13,
  kSilent = 14,
  kInternalError = 15,
  kStateLate = 16,
  kSolverFailed = 17,
  kDeadlineMissed = 18,
  kPlanRejected = 19,
  kStopDue = 20,  // a clear stop begins now, and none that begins later is clear
};

struct ControllerStatus {
  Mode mode = Mode::kInit;
  FaultCode fault_code = FaultCode::kNone;
  SolverStatus solver_status = SolverStatus::kNone;
  std::uint8_t iterations = 0;
  double solve_time = 0.0;            // time of the whole control step [s]
  std::uint16_t deadline_misses = 0;  // since start, modulo 1024
};
struct SchedulingHealth {
  double scheduling_error =
      0.0;  // max_j |p_j − p̂_j| / e_j: realised against predicted, in trust-region radii
  std::uint16_t active_rows = 0;  // active trust-region constraints
  double largest_slack = 0.0;     // in trust-region radii
};
// The planned horizon: a header frame, then one frame per point.
struct HorizonHeader {
  std::uint8_t points = 0;         // N + 1
  std::uint8_t state_counter = 0;  // counter of the state set at which the horizon starts
  double step = 0.0;               // t_s [s]
};
struct HorizonPoint {
  std::uint8_t index = 0;
  double X = 0.0;
  double Y = 0.0;
};

struct ControllerDiagnostics {
  ModeCause cause = ModeCause::kStart;  // why the present mode was entered
  Mode previous_mode = Mode::kInit;     // mode before the present one
  double countdown = 12.75;             // time until the stop begins [s]; 12.75: 12.75 s or longer, or none
  std::uint8_t faulty_message = 0;      // VAL_ FaultyMessage of vehicle.dbc, 0: none
  std::uint8_t frame_fault = 0;         // VAL_ FrameFault of vehicle.dbc, 0: none
  double cycle_latency = 0.0;       // last cycle started by a state: its arrival to both commands sent [s]
  std::uint16_t plans_refused = 0;  // since start, modulo 1024
};

enum class ConstraintVerdict : std::uint8_t { kMet = 0, kRelaxed = 1, kUnsolved = 2, kRejected = 3 };
enum class ConstraintName : std::uint8_t {
  kModel = 0,
  kInput = 1,
  kRate = 2,
  kState = 3,
  kRoad = 4,
  kObstacle = 5,
  kFriction = 6,
  kTrust = 7,
};

// The constraint that a plan could not meet.
struct ConstraintReport {
  ConstraintVerdict verdict = ConstraintVerdict::kMet;
  ConstraintName constraint = ConstraintName::kModel;
  std::uint8_t index = 0;  // id of the obstacle, or index of the state or input
  std::uint8_t step = 0;   // step of the horizon
  double amount = 0.0;     // in the unit of the constrained quantity
};

// What acts on the vehicle besides its inputs, as estimated.
struct DisturbanceEstimate {
  double steering_offset = 0.0;            // the front wheels stand at δ plus this [rad]
  double lateral_acceleration = 0.0;       // by bank and side wind, left positive [m/s²]
  double longitudinal_acceleration = 0.0;  // by slope and drag [m/s²]
  double stiffness_factor = 1.0;           // of the cornering stiffness of all tyres
  double grip = 0.0;                       // friction coefficient that plans count on
};

// The decision that a manoeuvre is, in the order of control::Decision.
enum class ManoeuvreDecision : std::uint8_t {
  kNone = 0,  // no decision in this cycle, or the controller makes none
  kDrive = 1,
  kPass = 2,
  kFollow = 3,
  kYield = 4,
  kWait = 5,
  kSqueeze = 6,
};
// Why the vehicle goes, or why it does not, in the order of control::Reason.
enum class ManoeuvreReason : std::uint8_t {
  kNone = 0,
  kWayFree = 1,
  kStayingCosts = 2,
  kCannotStay = 3,
  kLateForNow = 4,
  kTooLateToStop = 5,
  kRoadTooNarrow = 6,
  kNoGap = 7,
  kOncomingFirst = 8,
  kCrossingFirst = 9,
  kTooLate = 10,
  kNoPath = 11,
  kPassingGainsLittle = 12,
  kOpenTooShort = 13,
  kNoWay = 14,
};

// What was decided in a cycle about the other things on the road.
struct ManoeuvreStatus {
  static constexpr std::uint8_t kNoObject = 64;

  ManoeuvreDecision decision = ManoeuvreDecision::kNone;
  ManoeuvreReason reason = ManoeuvreReason::kNone;
  std::uint8_t object_id = kNoObject;        // object that decides
  PassingSide side = PassingSide::kUnknown;  // on which it is passed; kUnknown: it is not
  std::uint8_t left_out = 0;                 // objects that matter but could not be considered; at most 63
  double stop_distance = 409.5;              // to the stop line [m]; 409.5: 409.5 m or farther, or none
  double speed_limit = 81.9;                 // at the vehicle's place [m/s]; 81.9: none
};

using Message =
    std::variant<VehiclePose, VehicleMotion, VehicleFeedback, ObstaclePosition, ObstacleShape, ObstacleMotion,
                 ObstacleList, DriverRequest, SteeringCommand, AccelerationCommand, ControllerStatus,
                 SchedulingHealth, HorizonHeader, HorizonPoint, ControllerDiagnostics, ConstraintReport,
                 DisturbanceEstimate, ManoeuvreStatus>;

}  // namespace bus
