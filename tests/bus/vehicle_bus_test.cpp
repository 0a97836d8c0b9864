#include "bus/vehicle_bus.hpp"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "dbc/e2e.hpp"
#include "dbc/parser.hpp"

namespace bus {
namespace {

using dbc::EncodeStatus;
using testing::HasSubstr;

// One of each typed message, with no member at its default.
const std::vector<Message>& Samples() {
  static const std::vector<Message> kSamples{
      VehiclePose{.X = -1234.5678, .Y = 3355.4431},
      VehicleMotion{.upsilon = 13.9, .nu = -0.25, .omega = 0.4},
      VehicleFeedback{.psi = -3.14159, .delta = 0.31, .acceleration = -4.5},
      ObstaclePosition{.object_id = 63, .X = 55.25, .Y = -7.5},
      ObstacleShape{.object_id = 15,
                    .semi_axis_x = 20.0,
                    .semi_axis_y = 1.25,
                    .heading = 1.2,
                    .passing_side = PassingSide::kRight,
                    .outline = Outline::kBox},
      ObstacleMotion{.object_id = 1,
                     .velocity_X = -12.5,
                     .velocity_Y = 30.0,
                     .object_class = ObstacleClass::kPedestrian},
      ObstacleList{.count = 64},
      DriverRequest{.engage = true, .brake = false, .steering_override = true},
      SteeringCommand{
          .enable = true, .mode = Mode::kActive, .state_counter = 14, .plan_age = 63, .delta = -0.61},
      AccelerationCommand{
          .enable = true, .mode = Mode::kFault, .state_counter = 1, .plan_age = 2, .acceleration = -9.81},
      ControllerStatus{.mode = Mode::kSafeStop,
                       .fault_code = FaultCode::kPlanRejected,
                       .solver_status = SolverStatus::kNumericalFailure,
                       .iterations = 255,
                       .solve_time = 0.000042,
                       .deadline_misses = 1023},
      SchedulingHealth{.scheduling_error = 1.5, .active_rows = 600, .largest_slack = 0.125},
      HorizonHeader{.points = 9, .state_counter = 7, .step = 0.05},
      HorizonPoint{.index = 8, .X = 100.125, .Y = -2000.0},
      ControllerDiagnostics{.cause = ModeCause::kStopDue,
                            .previous_mode = Mode::kDegraded,
                            .countdown = 0.35,
                            .faulty_message = 6,
                            .frame_fault = 9,
                            .cycle_latency = 0.0123,
                            .plans_refused = 1023},
      ConstraintReport{.verdict = ConstraintVerdict::kRejected,
                       .constraint = ConstraintName::kObstacle,
                       .index = 63,
                       .step = 40,
                       .amount = 0.125},
      DisturbanceEstimate{.steering_offset = -0.0175,
                          .lateral_acceleration = 1.25,
                          .longitudinal_acceleration = -0.49,
                          .stiffness_factor = 0.85,
                          .grip = 0.635},
      ManoeuvreStatus{.decision = ManoeuvreDecision::kPass,
                      .reason = ManoeuvreReason::kNoWay,
                      .object_id = 63,
                      .side = PassingSide::kRight,
                      .left_out = 63,
                      .stop_distance = -1.5,
                      .speed_limit = 13.9},
  };
  return kSamples;
}

void ExpectSamePayload(const RawMessage& a, const RawMessage& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.data, b.data);
}

std::string ErrorOf(const std::string& dbc_text) {
  try {
    const VehicleBus bus(dbc::Parse(dbc_text, "foreign.dbc"));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

std::string Replaced(const std::string& from, const std::string& to) {
  std::string text(BuiltInDbc());
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

TEST(VehicleBus, EveryMessageComesBackAsTheSameTypeAndTheSameBits) {
  const VehicleBus bus;
  ASSERT_EQ(Samples().size(), std::variant_size_v<Message>);
  for (const Message& sample : Samples()) {
    RawMessage raw;
    ASSERT_EQ(bus.Encode(sample, 5, raw), EncodeStatus::kOk) << "type " << sample.index();
    const auto back = bus.Decode(raw.id, raw.Payload());
    ASSERT_TRUE(back) << "type " << sample.index();
    ASSERT_EQ(back->index(), sample.index());
    RawMessage again;
    ASSERT_EQ(bus.Encode(*back, 5, again), EncodeStatus::kOk);
    ExpectSamePayload(again, raw);
  }
}

TEST(VehicleBus, ValuesComeBackWithinHalfTheirResolution) {
  const VehicleBus bus;
  RawMessage raw;
  ASSERT_EQ(bus.Encode(VehicleFeedback{.psi = -3.14159, .delta = 0.31, .acceleration = -4.5}, 0, raw),
            EncodeStatus::kOk);
  const auto feedback = std::get<VehicleFeedback>(*bus.Decode(raw.id, raw.Payload()));
  EXPECT_NEAR(feedback.psi, -3.14159, 1.25e-5);
  EXPECT_NEAR(feedback.delta, 0.31, 5e-6);
  EXPECT_NEAR(feedback.acceleration, -4.5, 2.5e-4);

  const ControllerStatus status{.mode = Mode::kDegraded,
                                .fault_code = FaultCode::kPlanExhausted,
                                .solver_status = SolverStatus::kIterationLimit,
                                .iterations = 17,
                                .solve_time = 61e-6,
                                .deadline_misses = 700};
  ASSERT_EQ(bus.Encode(status, 0, raw), EncodeStatus::kOk);
  const auto back = std::get<ControllerStatus>(*bus.Decode(raw.id, raw.Payload()));
  EXPECT_EQ(back.mode, status.mode);
  EXPECT_EQ(back.fault_code, status.fault_code);
  EXPECT_EQ(back.solver_status, status.solver_status);
  EXPECT_EQ(back.iterations, status.iterations);
  EXPECT_NEAR(back.solve_time, status.solve_time, 5e-7);
  EXPECT_EQ(back.deadline_misses, status.deadline_misses);
}

TEST(VehicleBus, ObjectsHaveRoomForTheirSixtyFourIdsAndForALorry) {
  const VehicleBus bus;
  RawMessage raw;
  for (const auto& [id, half_length] : {std::pair{std::uint8_t{0}, 20.0}, {std::uint8_t{63}, 0.05}}) {
    const ObstacleShape shape{
        .object_id = id, .semi_axis_x = half_length, .semi_axis_y = 0.05, .outline = Outline::kBox};
    ASSERT_EQ(bus.Encode(shape, 0, raw), EncodeStatus::kOk);
    const auto back = std::get<ObstacleShape>(*bus.Decode(raw.id, raw.Payload()));
    EXPECT_EQ(back.object_id, id);
    EXPECT_NEAR(back.semi_axis_x, half_length, 1.25e-3);
    EXPECT_EQ(back.outline, Outline::kBox);
  }
  for (int i = 0; i <= static_cast<int>(ObstacleClass::kPedestrian); ++i) {
    const auto object_class = static_cast<ObstacleClass>(i);
    ASSERT_EQ(bus.Encode(ObstacleMotion{.object_class = object_class}, 0, raw), EncodeStatus::kOk);
    EXPECT_EQ(std::get<ObstacleMotion>(*bus.Decode(raw.id, raw.Payload())).object_class, object_class);
  }
  ASSERT_EQ(bus.Encode(ObstacleList{.count = 64}, 0, raw), EncodeStatus::kOk);
  EXPECT_EQ(std::get<ObstacleList>(*bus.Decode(raw.id, raw.Payload())).count, 64);
  EXPECT_EQ(bus.Encode(ObstacleList{.count = 65}, 0, raw), EncodeStatus::kSaturated);
}

TEST(VehicleBus, PiIsInsideTheRangeOfAnAngle) {
  const VehicleBus bus;
  RawMessage raw;
  EXPECT_EQ(bus.Encode(VehicleFeedback{.psi = M_PI}, 0, raw), EncodeStatus::kOk);
  EXPECT_EQ(bus.Encode(VehicleFeedback{.psi = -M_PI}, 0, raw), EncodeStatus::kOk);
  EXPECT_EQ(bus.Encode(ObstacleShape{.heading = -M_PI}, 0, raw), EncodeStatus::kOk);
}

TEST(VehicleBus, OwnFramesPassTheCheckWithTheirCounter) {
  const VehicleBus bus;
  for (const Message& sample : Samples()) {
    for (std::uint8_t counter = 0; counter < dbc::kCounterModulus; ++counter) {
      RawMessage raw;
      ASSERT_EQ(bus.Encode(sample, counter, raw), EncodeStatus::kOk);
      const E2eCheck check = bus.Check(raw.id, raw.Payload());
      ASSERT_EQ(check.verdict, E2eVerdict::kOk);
      ASSERT_EQ(check.counter, counter);
    }
  }
}

TEST(VehicleBus, AnyFlippedBitFailsTheCheck) {
  const VehicleBus bus;
  for (const Message& sample : Samples()) {
    RawMessage raw;
    ASSERT_EQ(bus.Encode(sample, 3, raw), EncodeStatus::kOk);
    for (std::size_t bit = 0; bit < 64; ++bit) {
      RawMessage flipped = raw;
      flipped.data[bit / 8] ^= std::byte{1} << (bit % 8);
      ASSERT_EQ(bus.Check(flipped.id, flipped.Payload()).verdict, E2eVerdict::kWrongCrc) << "bit " << bit;
    }
  }
}

TEST(VehicleBus, FrameUnderTheIdOfAnotherMessageFailsTheCheck) {
  const VehicleBus bus;
  for (const Message& sample : Samples()) {
    RawMessage raw;
    ASSERT_EQ(bus.Encode(sample, 3, raw), EncodeStatus::kOk);
    for (const MessageInfo& info : bus.messages()) {
      if (info.id == raw.id) continue;
      EXPECT_EQ(bus.Check(info.id, raw.Payload()).verdict, E2eVerdict::kWrongCrc);
    }
  }
}

TEST(VehicleBus, CounterOf15IsInvalid) {
  const VehicleBus bus;
  RawMessage raw;
  ASSERT_EQ(bus.Encode(ObstacleList{.count = 2}, 15, raw), EncodeStatus::kOk);
  EXPECT_EQ(bus.Check(raw.id, raw.Payload()).verdict, E2eVerdict::kInvalidCounter);
}

TEST(VehicleBus, ShortAndLongPayloadsFailTheCheckAndShortOnesDoNotDecode) {
  const VehicleBus bus;
  RawMessage raw;
  ASSERT_EQ(bus.Encode(ObstacleList{.count = 2}, 0, raw), EncodeStatus::kOk);
  for (std::size_t length = 0; length < 8; ++length) {
    EXPECT_EQ(bus.Check(raw.id, raw.Payload().first(length)).verdict, E2eVerdict::kWrongLength);
    EXPECT_FALSE(bus.Decode(raw.id, raw.Payload().first(length)));
  }
  const std::array<std::byte, 12> long_payload{};
  EXPECT_EQ(bus.Check(raw.id, long_payload).verdict, E2eVerdict::kWrongLength);
}

TEST(VehicleBus, IdOfNobodyIsUnknown) {
  const VehicleBus bus;
  const std::array<std::byte, 8> payload{};
  EXPECT_EQ(bus.Check(0x7FF, payload).verdict, E2eVerdict::kUnknownMessage);
  EXPECT_FALSE(bus.Decode(0x7FF, payload));
  EXPECT_EQ(bus.Find(0x7FFu), nullptr);
}

TEST(VehicleBus, ValueBeyondItsRangeSaturatesAndIsWritten) {
  const VehicleBus bus;
  RawMessage raw;
  ASSERT_EQ(bus.Encode(SteeringCommand{.mode = Mode::kActive, .delta = 5.0}, 2, raw),
            EncodeStatus::kSaturated);
  EXPECT_EQ(bus.Check(raw.id, raw.Payload()).verdict, E2eVerdict::kOk);
  const auto command = std::get<SteeringCommand>(*bus.Decode(raw.id, raw.Payload()));
  EXPECT_NEAR(command.delta, 1.048574, 1e-9);
  EXPECT_EQ(command.mode, Mode::kActive);
}

TEST(VehicleBus, ValueThatIsNotFiniteLeavesTheOutputUnchanged) {
  const VehicleBus bus;
  RawMessage raw{.id = 1, .length = 2, .data = {std::byte{3}}};
  const RawMessage before = raw;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(bus.Encode(SteeringCommand{.delta = nan}, 0, raw), EncodeStatus::kNotFinite);
  EXPECT_EQ(bus.Encode(AccelerationCommand{.acceleration = -infinity}, 0, raw), EncodeStatus::kNotFinite);
  EXPECT_EQ(bus.Encode(VehiclePose{.X = 1e9, .Y = nan}, 0, raw), EncodeStatus::kNotFinite);
  ExpectSamePayload(raw, before);
}

TEST(VehicleBus, MultiplexorAndEnumerationWithoutSuchValueDoNotDecode) {
  const VehicleBus bus;
  RawMessage raw;
  ASSERT_EQ(bus.Encode(ObstaclePosition{.object_id = 1}, 0, raw), EncodeStatus::kOk);
  const dbc::MessageDefinition& object = *bus.database().Find("ObstacleObject");
  dbc::WriteRaw(*object.Find("Part"), 3, raw.data);
  EXPECT_FALSE(bus.Decode(raw.id, raw.Payload()));

  ASSERT_EQ(bus.Encode(SteeringCommand{}, 0, raw), EncodeStatus::kOk);
  const dbc::MessageDefinition& command = *bus.database().Find("SteeringCommand");
  for (const unsigned mode : {6u, 7u}) {
    dbc::WriteRaw(*command.Find("Mode"), mode, raw.data);
    EXPECT_FALSE(bus.Decode(raw.id, raw.Payload()));
  }
}

TEST(VehicleBus, OwnFramesAreInRangeUntilOneOfTheirValuesIsNot) {
  const VehicleBus bus;
  RawMessage raw;
  for (const Message& sample : Samples()) {
    ASSERT_EQ(bus.Encode(sample, 0, raw), EncodeStatus::kOk);
    EXPECT_TRUE(bus.InRange(raw.id, raw.Payload()));
  }
  const dbc::MessageDefinition& object = *bus.database().Find("ObstacleObject");
  const dbc::Signal& heading = *object.Find("Heading");
  ASSERT_EQ(bus.Encode(ObstacleShape{}, 0, raw), EncodeStatus::kOk);
  dbc::WriteRaw(heading, 7854, raw.data);  // 3.1416
  EXPECT_TRUE(bus.InRange(raw.id, raw.Payload()));
  dbc::WriteRaw(heading, 7855, raw.data);
  EXPECT_FALSE(bus.InRange(raw.id, raw.Payload()));
  // In the frame of a position the same bits are part of Y.
  dbc::WriteRaw(*object.Find("Part"), 0, raw.data);
  EXPECT_TRUE(bus.InRange(raw.id, raw.Payload()));
}

TEST(VehicleBus, MessagesAreListedWithIdPeriodAndDistinctDataIds) {
  const VehicleBus bus;
  ASSERT_EQ(bus.messages().size(), 15u);
  std::set<std::uint16_t> data_ids;
  for (const MessageInfo& info : bus.messages()) {
    EXPECT_EQ(info.length, 8);
    EXPECT_DOUBLE_EQ(info.period, info.name == "ObstacleObject" ? 0.0 : 0.05) << info.name;
    EXPECT_EQ(bus.Find(info.id), &info);
    data_ids.insert(info.data_id);
  }
  EXPECT_EQ(data_ids.size(), bus.messages().size());
  EXPECT_EQ(bus.Info<SteeringCommand>().id, 0x200u);
}

TEST(VehicleBus, StaysBoundWhenMoved) {
  VehicleBus first;
  const VehicleBus second = std::move(first);
  RawMessage raw;
  EXPECT_EQ(second.Encode(VehiclePose{.X = 1.0}, 0, raw), EncodeStatus::kOk);
}

TEST(VehicleBus, TakesItsLayoutFromTheDbcAlone) {
  // The same names elsewhere on the wire: another id, Motorola byte order, another factor.
  std::string text = Replaced("BO_ 513 ", "BO_ 1281 ");
  for (std::size_t at = 0; (at = text.find(" 513 ", at)) != std::string::npos;) text.replace(at, 5, " 1281 ");
  const std::string from = "Acceleration : 26|18@1- (0.0001,0)";
  text.replace(text.find(from), from.size(), "Acceleration : 39|24@0- (0.00001,0)");
  const VehicleBus bus(dbc::Parse(text, "foreign.dbc"));
  RawMessage raw;
  ASSERT_EQ(bus.Encode(AccelerationCommand{.acceleration = -1.23456}, 0, raw), EncodeStatus::kOk);
  EXPECT_EQ(raw.id, 1281u);
  EXPECT_EQ(raw.data[4], std::byte{0xFE});  // the sign is in the first byte of a Motorola signal
  EXPECT_NEAR(std::get<AccelerationCommand>(*bus.Decode(1281, raw.Payload())).acceleration, -1.23456, 1e-9);
}

TEST(VehicleBus, ForeignDbcThatLacksSomethingIsRefusedByName) {
  EXPECT_THAT(ErrorOf(Replaced("BO_ 513 AccelerationCommand", "BO_ 513 Acceleration")),
              HasSubstr("foreign.dbc: there is no message AccelerationCommand"));
  EXPECT_THAT(ErrorOf(Replaced(" SG_ Nu ", " SG_ Lateral ")),
              HasSubstr("message VehicleMotion has no signal Nu"));
  EXPECT_THAT(ErrorOf(Replaced(" SG_ CRC ", " SG_ Checksum ")),
              HasSubstr("message VehiclePose has no signal CRC"));
  EXPECT_THAT(ErrorOf(Replaced("BA_ \"E2EDataId\" BO_ 258 4866;", "")),
              HasSubstr("message VehicleFeedback has no attribute E2EDataId"));
  EXPECT_THAT(ErrorOf(Replaced("BO_ 258 VehicleFeedback", "BO_ 2147483906 VehicleFeedback")),
              HasSubstr("message VehicleFeedback has an extended id"));
  EXPECT_THAT(ErrorOf(Replaced("SG_ CRC : 0|8@1+", "SG_ CRC : 56|8@1+")), HasSubstr("VehiclePose"));
  EXPECT_THAT(ErrorOf(Replaced("SG_ VelocityX m2", "SG_ VelocityX m1")), HasSubstr("VelocityY"));
}

TEST(VehicleBus, ForeignDbcWhoseSignalsOverlapIsRefusedByName) {
  EXPECT_THAT(ErrorOf(Replaced("SG_ Delta : 26|", "SG_ Delta : 25|")),
              HasSubstr("signal Delta of message SteeringCommand overlaps"));
  EXPECT_THAT(ErrorOf(Replaced("SG_ StateCounter : 12|4@1+", "SG_ StateCounter : 11|4@1+")),
              HasSubstr("signal StateCounter of message SteeringCommand overlaps"));  // the counter
  EXPECT_THAT(ErrorOf(Replaced("SG_ VelocityX m2 : 20|", "SG_ VelocityX m2 : 13|")),
              HasSubstr("signal VelocityX of message ObstacleObject overlaps"));  // the multiplexor
}

}  // namespace
}  // namespace bus
