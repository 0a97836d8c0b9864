// Prints random frames of every kind, one per line, for comparison with a second decoder:
//   ID HEX name=value name=value ...
// The values are those that our codec decodes. The frames are typed messages, with extremes, and random bits.
#include <array>
#include <bit>
#include <cstdio>
#include <random>
#include <utility>

#include "bus/vehicle_bus.hpp"
#include "dbc/codec.hpp"

namespace {

void Print(const dbc::MessageDefinition& message, std::span<const std::byte> payload) {
  std::printf("%u ", message.id);
  for (const std::byte b : payload) std::printf("%02X", std::to_integer<unsigned>(b));
  for (const dbc::Signal& signal : message.signals) {
    if (!dbc::IsPresent(message, signal, payload)) continue;
    std::printf(" %s=%.17g", signal.name.c_str(), dbc::DecodeSignal(signal, payload));
  }
  std::printf("\n");
}

class Values {
 public:
  double Real() {
    static constexpr std::array<double, 6> kExtremes{0.0, -0.0, 1e9, -1e9, 1e-9, 3.14159};
    if (random_() % 4 == 0) return kExtremes.at(random_() % kExtremes.size());
    return std::uniform_real_distribution<double>(-100.0, 100.0)(random_);
  }
  std::uint8_t Byte(unsigned end) { return static_cast<std::uint8_t>(random_() % end); }
  bool Bool() { return random_() % 2 == 0; }
  template <typename Enum>
  Enum One(Enum last) {
    return static_cast<Enum>(random_() % (static_cast<unsigned>(last) + 1));
  }
  std::uint64_t Bits() { return random_(); }

 private:
  std::mt19937_64 random_{7};
};

std::array<bus::Message, std::variant_size_v<bus::Message>> RandomMessages(Values& v) {
  return {bus::VehiclePose{v.Real(), v.Real()},
          bus::VehicleMotion{v.Real(), v.Real(), v.Real()},
          bus::VehicleFeedback{v.Real(), v.Real(), v.Real()},
          bus::ObstaclePosition{v.Byte(64), v.Real(), v.Real()},
          bus::ObstacleShape{v.Byte(64), v.Real(), v.Real(), v.Real(), v.One(bus::PassingSide::kRight),
                             v.One(bus::Outline::kBox)},
          bus::ObstacleMotion{v.Byte(64), v.Real(), v.Real(), v.One(bus::ObstacleClass::kPedestrian)},
          bus::ObstacleList{v.Byte(65)},
          bus::DriverRequest{v.Bool(), v.Bool(), v.Bool()},
          bus::SteeringCommand{v.Bool(), v.One(bus::Mode::kFault), v.Byte(16), v.Byte(64), v.Real()},
          bus::AccelerationCommand{v.Bool(), v.One(bus::Mode::kFault), v.Byte(16), v.Byte(64), v.Real()},
          bus::ControllerStatus{v.One(bus::Mode::kFault), v.One(bus::FaultCode::kPlanRejected),
                                v.One(bus::SolverStatus::kNumericalFailure), v.Byte(256), v.Real() * 1e-3,
                                v.Byte(256)},
          bus::SchedulingHealth{v.Real(), v.Byte(256), v.Real()},
          bus::HorizonHeader{v.Byte(128), v.Byte(16), v.Real()},
          bus::HorizonPoint{v.Byte(128), v.Real(), v.Real()},
          bus::ControllerDiagnostics{v.One(bus::ModeCause::kStopDue), v.One(bus::Mode::kFault), v.Real(),
                                     v.Byte(7), v.Byte(10), v.Real(), v.Byte(256)},
          bus::ConstraintReport{v.One(bus::ConstraintVerdict::kRejected), v.One(bus::ConstraintName::kTrust),
                                v.Byte(64), v.Byte(128), v.Real()},
          bus::DisturbanceEstimate{v.Real(), v.Real(), v.Real(), v.Real(), v.Real()},
          bus::ManoeuvreStatus{v.One(bus::ManoeuvreDecision::kSqueeze), v.One(bus::ManoeuvreReason::kNoWay),
                               v.Byte(65), v.One(bus::PassingSide::kRight), v.Byte(64), v.Real(), v.Real()}};
}

}  // namespace

int main() {
  const bus::VehicleBus bus;
  Values values;
  for (int round = 0; round < 100; ++round) {
    for (const bus::Message& message : RandomMessages(values)) {
      bus::RawMessage raw;
      if (bus.Encode(message, values.Byte(15), raw) == dbc::EncodeStatus::kNotFinite) return 1;
      Print(*bus.database().Find(raw.id, false), raw.Payload());
    }
    for (const dbc::MessageDefinition& message : bus.database().messages) {
      const std::uint64_t bits = round == 0 ? 0 : round == 1 ? ~std::uint64_t{0} : values.Bits();
      const auto payload = std::bit_cast<std::array<std::byte, 8>>(bits);
      Print(message, payload);
    }
  }
  return 0;
}
