#include "can/candump_log.hpp"

#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <linux/can.h>
#include <net/if.h>

namespace can {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

int HexValue(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  return -1;
}

// Reads a line from left to right. The first failure is kept; later attempts to read fail, too.
class Reader {
 public:
  explicit Reader(std::string_view line) : line_(line) {}

  [[nodiscard]] bool failed() const { return !error_.empty(); }
  [[nodiscard]] const std::string& error() const { return error_; }

  bool Fail(const std::string& message) { return FailAt(position_, message); }
  bool FailAt(std::size_t position, const std::string& message) {
    if (!failed()) error_ = "column " + std::to_string(position + 1) + ": " + message;
    return false;
  }

  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] bool AtEnd() const { return position_ == line_.size(); }

  bool Accept(std::string_view text) {
    if (failed() || !line_.substr(position_).starts_with(text)) return false;
    position_ += text.size();
    return true;
  }

  bool Expect(std::string_view text, const std::string& name) {
    return Accept(text) || Fail("expected " + name);
  }

  // Takes the characters before the next of `ends` or before the end of the line.
  std::string_view Until(std::string_view ends) {
    const std::size_t begin = position_;
    position_ = std::min(line_.find_first_of(ends, begin), line_.size());
    return line_.substr(begin, position_ - begin);
  }

  void SkipBlanks() { position_ = std::min(line_.find_first_not_of(kBlanks, position_), line_.size()); }

  // Takes the next hexadecimal digit and returns its value; -1 if there is none.
  int HexDigit() {
    const int value = AtEnd() ? -1 : HexValue(line_[position_]);
    if (value >= 0) ++position_;
    return value;
  }

 private:
  std::string_view line_;
  std::size_t position_ = 0;
  std::string error_;
};

bool ReadDecimal(std::string_view digits, std::int64_t max, std::int64_t& value) {
  value = 0;
  for (const char digit : digits) {
    if (digit < '0' || digit > '9') return false;
    value = 10 * value + (digit - '0');
    if (value > max) return false;
  }
  return !digits.empty();
}

bool ReadTime(Reader& reader, Time& time) {
  if (!reader.Expect("(", "'(' and the time")) return false;
  constexpr std::int64_t kMaxSeconds = std::numeric_limits<std::int64_t>::max() / 1'000'000'000 - 1;
  std::int64_t seconds = 0;
  std::int64_t microseconds = 0;
  std::size_t begin = reader.position();
  if (!ReadDecimal(reader.Until(".) \t"), kMaxSeconds, seconds)) {
    return reader.FailAt(begin, "expected seconds, 0 to " + std::to_string(kMaxSeconds));
  }
  if (!reader.Expect(".", "'.' and six decimals of the time")) return false;
  begin = reader.position();
  const std::string_view decimals = reader.Until(") \t");
  if (decimals.size() != 6 || !ReadDecimal(decimals, 999'999, microseconds)) {
    return reader.FailAt(begin, "expected six decimals of the time");
  }
  time = Time(std::chrono::seconds(seconds) + std::chrono::microseconds(microseconds));
  return reader.Expect(")", "')' after the time");
}

bool ReadInterface(Reader& reader, std::string& interface) {
  reader.SkipBlanks();
  const std::size_t begin = reader.position();
  interface = reader.Until(kBlanks);
  if (interface.empty() || interface.size() >= IFNAMSIZ) {
    return reader.FailAt(begin, "expected an interface name of 1 to 15 characters");
  }
  return true;
}

bool ReadId(Reader& reader, Frame& frame) {
  reader.SkipBlanks();
  const std::size_t begin = reader.position();
  const std::string_view digits = reader.Until("# \t");
  std::uint32_t id = 0;
  for (const char digit : digits) {
    const int value = HexValue(digit);
    if (value < 0) return reader.FailAt(begin, "expected an id of hexadecimal digits");
    id = 16 * id + static_cast<std::uint32_t>(value);
  }
  if (digits.size() == 3) {
    if (id > kMaxStandardId) return reader.FailAt(begin, "standard id above 7FF");
  } else if (digits.size() == 8) {
    if (id > (kMaxExtendedId | CAN_ERR_FLAG)) return reader.FailAt(begin, "extended id above 1FFFFFFF");
    frame.kind = (id & CAN_ERR_FLAG) != 0 ? FrameKind::kError : FrameKind::kData;
    frame.extended = frame.kind == FrameKind::kData;
  } else {
    return reader.FailAt(begin, "expected an id of three or eight digits");
  }
  frame.id = id & ~CAN_ERR_FLAG;
  return reader.Expect("#", "'#' after the id");
}

bool ReadPayload(Reader& reader, Frame& frame) {
  const std::size_t begin = reader.position();
  for (int high = reader.HexDigit(); high >= 0; high = reader.HexDigit()) {
    const int low = reader.HexDigit();
    if (low < 0) return reader.Fail("expected the second digit of a byte");
    if (frame.length == kMaxFdLength) return reader.FailAt(begin, "payload of more than 64 bytes");
    frame.data[frame.length++] = static_cast<std::byte>(16 * high + low);
  }
  if (!IsValid(frame)) {
    return reader.FailAt(begin, "no " + std::string(frame.fd ? "FD" : "classic") +
                                    " frame has a payload of " + std::to_string(frame.length) + " bytes");
  }
  return true;
}

bool ReadContent(Reader& reader, Frame& frame) {
  const std::size_t begin = reader.position();
  if (reader.Accept("#")) {
    const int flags = reader.HexDigit();
    if (flags < 0) return reader.Fail("expected one digit of FD flags");
    frame.fd = true;
    frame.fd_flags = static_cast<std::uint8_t>(flags) & (CANFD_BRS | CANFD_ESI);
    if (frame.kind == FrameKind::kError) return reader.FailAt(begin, "no FD frame has an error id");
    return ReadPayload(reader, frame);
  }
  if (reader.Accept("R") || reader.Accept("r")) {
    if (frame.kind == FrameKind::kError) return reader.FailAt(begin, "no remote frame has an error id");
    frame.kind = FrameKind::kRemote;
    const std::size_t length_begin = reader.position();
    if (const int length = reader.HexDigit(); length >= 0) frame.length = static_cast<std::uint8_t>(length);
    return IsValid(frame) || reader.FailAt(length_begin, "length of a remote frame above 8");
  }
  return ReadPayload(reader, frame);
}

bool ReadEnd(Reader& reader) {
  const std::size_t begin = reader.position();
  reader.SkipBlanks();
  if (reader.position() > begin && (reader.Accept("T") || reader.Accept("R"))) reader.SkipBlanks();
  return reader.AtEnd() || reader.Fail("unexpected text after the frame");
}

}  // namespace

tl::expected<std::optional<LogEntry>, std::string> ParseCandumpLine(std::string_view line) {
  Reader reader(line);
  reader.SkipBlanks();
  if (reader.AtEnd() || reader.Accept("#")) return std::nullopt;
  LogEntry entry;
  if (ReadTime(reader, entry.frame.timestamp) && ReadInterface(reader, entry.interface) &&
      ReadId(reader, entry.frame) && ReadContent(reader, entry.frame) && ReadEnd(reader)) {
    return entry;
  }
  return tl::make_unexpected(reader.error());
}

std::string FormatCandumpLine(const Frame& frame, std::string_view interface) {
  const auto microseconds =
      std::chrono::floor<std::chrono::microseconds>(frame.timestamp.time_since_epoch()).count();
  char text[64];
  std::snprintf(text, sizeof(text), "(%010" PRId64 ".%06" PRId64 ") ", std::int64_t{microseconds / 1'000'000},
                std::int64_t{microseconds % 1'000'000});
  std::string line = text;
  line += interface;
  const bool is_error = frame.kind == FrameKind::kError;
  std::snprintf(text, sizeof(text), frame.extended || is_error ? " %08" PRIX32 "#" : " %03" PRIX32 "#",
                frame.id | (is_error ? CAN_ERR_FLAG : 0));
  line += text;
  if (frame.kind == FrameKind::kRemote) {
    line += 'R';
    if (frame.length > 0) line += static_cast<char>('0' + frame.length);
    return line;
  }
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  if (frame.fd) {
    line += '#';
    line += kDigits[frame.fd_flags & 0xF];
  }
  for (const std::byte byte : frame.Payload()) {
    line += kDigits[std::to_integer<std::size_t>(byte >> 4)];
    line += kDigits[std::to_integer<std::size_t>(byte & std::byte{0xF})];
  }
  return line;
}

}  // namespace can
