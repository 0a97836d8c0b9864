#include "dbc/e2e.hpp"

#include <array>

namespace dbc {
namespace {

constexpr std::array<std::uint8_t, 256> MakeTable() {
  std::array<std::uint8_t, 256> table{};
  for (unsigned value = 0; value < table.size(); ++value) {
    unsigned crc = value;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x80u) != 0 ? (crc << 1) ^ 0x1Du : crc << 1;
    table[value] = static_cast<std::uint8_t>(crc);
  }
  return table;
}

constexpr std::array<std::uint8_t, 256> kTable = MakeTable();

}  // namespace

std::uint8_t Crc8J1850(std::span<const std::byte> bytes, std::uint8_t initial, std::uint8_t final_xor) {
  std::uint8_t crc = initial;
  for (const std::byte b : bytes) crc = kTable[crc ^ std::to_integer<std::uint8_t>(b)];
  return crc ^ final_xor;
}

std::uint8_t E2eProfile1Crc(std::uint16_t data_id, std::span<const std::byte> payload) {
  const std::array id_bytes{static_cast<std::byte>(data_id & 0xFF), static_cast<std::byte>(data_id >> 8)};
  const std::uint8_t crc = Crc8J1850(id_bytes, 0x00, 0x00);
  return payload.empty() ? crc : Crc8J1850(payload.subspan(1), crc, 0x00);
}

}  // namespace dbc
