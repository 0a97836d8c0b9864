// A CAN frame as it appears on the wire, with the time at which it was received.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

namespace can {

// Time at which a frame was stamped: by CLOCK_REALTIME at a Socket, by the simulation's own clock in memory. It is a
// type of its own, so that it is not mistaken for the monotonic time inside the daemon (base::Time).
using Time = std::chrono::sys_time<std::chrono::nanoseconds>;

inline constexpr std::uint32_t kMaxStandardId = 0x7FF;
inline constexpr std::uint32_t kMaxExtendedId = 0x1FFFFFFF;
inline constexpr std::size_t kMaxClassicLength = 8;
inline constexpr std::size_t kMaxFdLength = 64;

enum class FrameKind : std::uint8_t {
  kData,    // classic or FD data frame
  kRemote,  // classic remote frame: `length` is the requested length, there is no payload
  kError,   // error frame of the interface: `id` holds the error class bits (linux/can/error.h)
};

struct Frame {
  std::uint32_t id = 0;  // 11 bits, 29 bits if `extended`, error class bits if kind == kError
  bool extended = false;
  FrameKind kind = FrameKind::kData;
  bool fd = false;
  std::uint8_t fd_flags = 0;  // CANFD_BRS, CANFD_ESI
  std::uint8_t length = 0;    // payload length [bytes]: 0..8; FD also 12, 16, 20, 24, 32, 48, 64
  std::array<std::byte, kMaxFdLength> data{};
  Time timestamp{};

  [[nodiscard]] std::span<const std::byte> Payload() const {
    return {data.data(), kind == FrameKind::kRemote ? std::size_t{0} : length};
  }
};

// True if the frame can occur on a bus: its id and length are in range, and it is FD only if it is a data frame.
[[nodiscard]] bool IsValid(const Frame& frame);

// True if both look the same on the wire; time stamps are not compared.
[[nodiscard]] bool SameOnWire(const Frame& a, const Frame& b);

}  // namespace can
