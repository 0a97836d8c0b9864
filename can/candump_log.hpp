// Lines of a candump log, as `candump -l` and `candump -L` write them and canplayer reads them.
//
//   (1700000000.123456) vcan0 123#1122            data frame with a standard id: three digits
//   (1700000000.123456) vcan0 12345678#           data frame with an extended id: eight digits
//   (1700000000.123456) vcan0 123#R4              remote frame that requests 4 bytes; a lone R requests none
//   (1700000000.123456) vcan0 123##31122          FD frame: one digit of flags, then the payload
//   (1700000000.123456) vcan0 20000004#0004...    error frame: eight digits, CAN_ERR_FLAG (20000000) set
//
// The time has exactly six decimals. Hexadecimal digits may have either case; a suffix " T" or " R"
// (candump -x) is accepted and ignored. The FD flags CANFD_BRS and CANFD_ESI are kept.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "can/frame.hpp"

namespace can {

struct LogEntry {
  Frame frame;  // with its time stamp
  std::string interface;
};

// Parses one line without its newline; nullopt for a blank line or a comment, which begins with '#'. The error
// names the column, counted from 1, and what was expected there.
[[nodiscard]] tl::expected<std::optional<LogEntry>, std::string> ParseCandumpLine(std::string_view line);

// Formats the line of a frame, without a newline; the time is truncated to microseconds. The frame must be valid
// (IsValid) and its time not before the epoch.
[[nodiscard]] std::string FormatCandumpLine(const Frame& frame, std::string_view interface);

}  // namespace can
