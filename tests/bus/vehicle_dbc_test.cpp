// Rules that vehicle.dbc itself must satisfy.
#include <gtest/gtest.h>
#include <set>
#include <string>

#include "bus/vehicle_bus.hpp"
#include "dbc/codec.hpp"
#include "dbc/parser.hpp"

namespace bus {
namespace {

class VehicleDbc : public testing::Test {
 protected:
  const dbc::Database database_ = dbc::Parse(BuiltInDbc(), "vehicle.dbc");
};

TEST_F(VehicleDbc, IsReadWithoutWarnings) {
  EXPECT_TRUE(database_.warnings.empty()) << database_.warnings.front();
}

TEST_F(VehicleDbc, EveryMessageIsClassicCanWithCrcAndCounterInTheSamePlace) {
  for (const dbc::MessageDefinition& message : database_.messages) {
    SCOPED_TRACE(message.name);
    EXPECT_EQ(message.length, 8u);
    EXPECT_FALSE(message.extended);
    EXPECT_FALSE(message.comment.empty());
    const dbc::Signal* crc = message.Find("CRC");
    const dbc::Signal* counter = message.Find("Counter");
    ASSERT_NE(crc, nullptr);
    ASSERT_NE(counter, nullptr);
    EXPECT_EQ(crc->start_bit, 0u);
    EXPECT_EQ(crc->length, 8u);
    EXPECT_EQ(counter->start_bit, 8u);
    EXPECT_EQ(counter->length, 4u);
  }
}

TEST_F(VehicleDbc, NoTwoSignalsOfOneFrameShareABit) {
  for (const dbc::MessageDefinition& message : database_.messages) {
    std::set<std::uint64_t> pages{0};
    for (const dbc::Signal& signal : message.signals) {
      if (signal.multiplexing) pages.insert(signal.multiplexing->values.front().first);
    }
    for (const std::uint64_t page : pages) {
      std::uint64_t taken = 0;
      for (const dbc::Signal& signal : message.signals) {
        if (signal.multiplexing && signal.multiplexing->values.front().first != page) continue;
        ASSERT_EQ(signal.byte_order, dbc::ByteOrder::kIntel);
        const std::uint64_t own = (~std::uint64_t{0} >> (64 - signal.length)) << signal.start_bit;
        EXPECT_EQ(taken & own, 0u) << message.name << ' ' << signal.name;
        taken |= own;
      }
    }
  }
}

TEST_F(VehicleDbc, EveryRangeIsHeldByTheBits) {
  for (const dbc::MessageDefinition& message : database_.messages) {
    for (dbc::Signal signal : message.signals) {
      SCOPED_TRACE(message.name + " " + signal.name);
      ASSERT_TRUE(signal.HasRange());
      const double ends[] = {signal.min, signal.max};
      signal.min = signal.max = 0.0;  // no range: only the bits limit the value
      for (const double end : ends) {
        std::array<std::byte, 8> payload{};
        EXPECT_EQ(dbc::EncodeSignal(signal, end, payload), dbc::EncodeStatus::kOk);
        EXPECT_NEAR(dbc::DecodeSignal(signal, payload), end, 0.5 * signal.factor + 1e-12);
      }
    }
  }
}

TEST_F(VehicleDbc, EnumerationsHaveATextForEachOfTheirValues) {
  for (const dbc::MessageDefinition& message : database_.messages) {
    for (const char* name : {"Mode", "FaultCode", "SolverStatus", "PassingSide", "Shape", "Class", "Part",
                             "Page", "Cause", "PreviousMode", "FaultyMessage", "FrameFault", "Verdict",
                             "Constraint", "Decision", "Reason", "Side"}) {
      const dbc::Signal* signal = message.Find(name);
      if (signal == nullptr) continue;
      EXPECT_EQ(signal->values.size(), static_cast<std::size_t>(signal->max) + 1) << name;
    }
  }
  const dbc::Signal* fault = database_.Find("ControllerStatus")->Find("FaultCode");
  EXPECT_EQ(fault->values.at(static_cast<int>(FaultCode::kBusDown)), "BusDown");
  EXPECT_EQ(fault->values.at(static_cast<int>(FaultCode::kInternalError)), "InternalError");
  EXPECT_EQ(fault->max, static_cast<double>(FaultCode::kPlanRejected));
  const dbc::Signal* cause = database_.Find("ControllerDiagnostics")->Find("Cause");
  EXPECT_EQ(cause->values.at(static_cast<int>(ModeCause::kReleased)), "RequestWithdrawn");
  EXPECT_EQ(cause->values.at(static_cast<int>(ModeCause::kSilent)), "Silent");
  EXPECT_EQ(cause->max, static_cast<double>(ModeCause::kStopDue));
  const dbc::Signal* object_class = database_.Find("ObstacleObject")->Find("Class");
  EXPECT_EQ(object_class->values.at(static_cast<int>(ObstacleClass::kCycle)), "Cycle");
  EXPECT_EQ(object_class->max, static_cast<double>(ObstacleClass::kPedestrian));
  const dbc::Signal* shape = database_.Find("ObstacleObject")->Find("Shape");
  EXPECT_EQ(shape->values.at(static_cast<int>(Outline::kBox)), "Box");
  EXPECT_EQ(shape->max, static_cast<double>(Outline::kBox));
  const dbc::Signal* constraint = database_.Find("ConstraintReport")->Find("Constraint");
  EXPECT_EQ(constraint->max, static_cast<double>(ConstraintName::kTrust));
  const dbc::MessageDefinition& manoeuvre = *database_.Find("ManoeuvreStatus");
  const dbc::Signal* decision = manoeuvre.Find("Decision");
  EXPECT_EQ(decision->values.at(static_cast<int>(ManoeuvreDecision::kYield)), "Yield");
  EXPECT_EQ(decision->max, static_cast<double>(ManoeuvreDecision::kSqueeze));
  const dbc::Signal* reason = manoeuvre.Find("Reason");
  EXPECT_EQ(reason->values.at(static_cast<int>(ManoeuvreReason::kOncomingFirst)), "OncomingFirst");
  EXPECT_EQ(reason->max, static_cast<double>(ManoeuvreReason::kNoWay));
  EXPECT_EQ(manoeuvre.Find("ObjectId")->values.at(ManoeuvreStatus::kNoObject), "None");
}

}  // namespace
}  // namespace bus
