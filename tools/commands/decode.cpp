#include "tools/commands/decode.hpp"

#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <utility>

#include "bus/vehicle_bus.hpp"
#include "can/candump_log.hpp"
#include "dbc/codec.hpp"
#include "dbc/e2e.hpp"

namespace tools {
namespace {

std::string Decimal(double value, int decimals) {
  char text[350];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

// The number of decimals that resolves every step of the signal, at most nine.
int Decimals(const dbc::Signal& signal) {
  int decimals = 0;
  const auto is_whole = [](double value) { return std::abs(value - std::round(value)) < 1e-6; };
  for (double scale = 1.0; decimals < 9; ++decimals, scale *= 10.0) {
    if (is_whole(signal.factor * scale) && is_whole(signal.offset * scale)) break;
  }
  return decimals;
}

std::string ValueOf(const dbc::Signal& signal, std::span<const std::byte> payload) {
  if (const std::string* text = dbc::ValueText(signal, payload)) return *text;
  const std::string number = Decimal(dbc::DecodeSignal(signal, payload), Decimals(signal));
  return signal.unit.empty() ? number : number + " " + signal.unit;
}

class Decoder {
 public:
  [[nodiscard]] std::string Line(const can::LogEntry& entry) {
    const std::string strange = Strangeness(entry.frame);
    if (!strange.empty()) return can::FormatCandumpLine(entry.frame, entry.interface) + " | " + strange;
    return TimeOf(entry.frame) + " " + entry.interface + " " + Signals(entry.frame) + " | " + Verdict(entry);
  }

 private:
  [[nodiscard]] static std::string TimeOf(const can::Frame& frame) {
    const long long microseconds =
        std::chrono::floor<std::chrono::microseconds>(frame.timestamp.time_since_epoch()).count();
    char text[40];
    std::snprintf(text, sizeof text, "(%010lld.%06lld)", microseconds / 1'000'000, microseconds % 1'000'000);
    return text;
  }

  // The reason why the frame does not belong to vehicle.dbc; empty if it does.
  [[nodiscard]] std::string Strangeness(const can::Frame& frame) const {
    if (frame.kind == can::FrameKind::kError) return "error frame";
    const bus::MessageInfo* info = frame.extended ? nullptr : bus_.Find(frame.id);
    if (info == nullptr) return "unknown id";
    if (frame.kind == can::FrameKind::kRemote) return info->name + ", but a remote frame";
    if (frame.fd) return info->name + ", but an FD frame";
    if (frame.length == info->length) return {};
    return info->name + ", but of " + std::to_string(frame.length) + " bytes, expected " +
           std::to_string(info->length);
  }

  [[nodiscard]] std::string Signals(const can::Frame& frame) const {
    const dbc::MessageDefinition& message = *bus_.database().Find(frame.id, false);
    std::string text = message.name;
    for (const dbc::Signal& signal : message.signals) {
      if (signal.name == bus::kCrcSignal || signal.name == bus::kCounterSignal) continue;
      if (!dbc::IsPresent(message, signal, frame.Payload())) continue;
      text += " " + signal.name + "=" + ValueOf(signal, frame.Payload());
    }
    return text;
  }

  [[nodiscard]] std::string Verdict(const can::LogEntry& entry) {
    const bus::E2eCheck check = bus_.Check(entry.frame.id, entry.frame.Payload());
    const std::string counter = std::to_string(check.counter);
    if (check.verdict == bus::E2eVerdict::kWrongCrc) return "crc BAD, counter " + counter + " not judged";
    if (check.verdict == bus::E2eVerdict::kInvalidCounter) return "crc ok, counter " + counter + " invalid";
    return "crc ok, counter " + counter + " " + CounterVerdict(entry, check.counter);
  }

  [[nodiscard]] std::string CounterVerdict(const can::LogEntry& entry, std::uint8_t counter) {
    const auto [last, is_first] = counters_.try_emplace({entry.interface, entry.frame.id}, counter);
    if (is_first) return "first";
    const std::uint8_t before = std::exchange(last->second, counter);
    if (counter == before) return "repeated";
    const int lost = (counter + dbc::kCounterModulus - dbc::NextCounter(before)) % dbc::kCounterModulus;
    return lost == 0 ? "ok" : "lost " + std::to_string(lost);
  }

  bus::VehicleBus bus_;
  // The counter of the last frame with a good CRC, for each interface and id.
  std::map<std::pair<std::string, std::uint32_t>, std::uint8_t> counters_;
};

}  // namespace

int RunDecode(std::istream& in, const std::string& name, std::ostream& out, std::ostream& err) {
  Decoder decoder;
  bool failed = false;
  std::string line;
  for (long number = 1; out && std::getline(in, line); ++number) {
    const auto entry = can::ParseCandumpLine(line);
    if (!entry) {
      err << name << ':' << number << ": " << entry.error() << '\n' << std::flush;
      failed = true;
    } else if (const std::optional<can::LogEntry>& frame = *entry) {
      out << decoder.Line(*frame) << '\n';
      if (in.rdbuf()->in_avail() <= 0) out.flush();
    }
  }
  out.flush();
  if (in.bad()) err << name << ": cannot be read\n";
  if (!out) err << name << ": the output cannot be written\n";
  return failed || in.bad() || !out ? 1 : 0;
}

}  // namespace tools
