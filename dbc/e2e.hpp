// End-to-end protection in the style of AUTOSAR E2E profile 1: a CRC-8 with the SAE J1850 polynomial (0x1D,
// initial value 0, no final xor) over the data id (low byte, high byte) and every byte of the payload except the
// CRC's own, and a counter 0..14 that increases by one, modulo 15, with every transmission.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace dbc {

inline constexpr std::uint8_t kCounterModulus = 15;  // 15 (0xF) is invalid

[[nodiscard]] constexpr std::uint8_t NextCounter(std::uint8_t counter) {
  return static_cast<std::uint8_t>((counter + 1) % kCounterModulus);
}

// CRC-8 with polynomial x⁸+x⁴+x³+x²+1 (0x1D), most significant bit first.
[[nodiscard]] std::uint8_t Crc8J1850(std::span<const std::byte> bytes, std::uint8_t initial,
                                     std::uint8_t final_xor);

// CRC of a payload whose CRC byte is byte 0.
[[nodiscard]] std::uint8_t E2eProfile1Crc(std::uint16_t data_id, std::span<const std::byte> payload);

}  // namespace dbc
