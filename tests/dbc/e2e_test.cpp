#include "dbc/e2e.hpp"

#include <array>
#include <gtest/gtest.h>
#include <string_view>

namespace {

std::span<const std::byte> Bytes(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(Crc8J1850, CheckValueOfTheStandard) {
  EXPECT_EQ(dbc::Crc8J1850(Bytes("123456789"), 0xFF, 0xFF), 0x4B);
}

TEST(Crc8J1850, CanBeTakenInParts) {
  const std::uint8_t first = dbc::Crc8J1850(Bytes("1234"), 0xFF, 0x00);
  EXPECT_EQ(dbc::Crc8J1850(Bytes("56789"), first, 0xFF), 0x4B);
}

TEST(E2eProfile1, PublishedValuesOfDataId0x123) {
  std::array<std::byte, 8> payload{};
  EXPECT_EQ(dbc::E2eProfile1Crc(0x123, payload), 0xCC);
  payload[1] = std::byte{1};  // the counter, in the low half of byte 1
  EXPECT_EQ(dbc::E2eProfile1Crc(0x123, payload), 0x91);
}

TEST(E2eProfile1, CrcDoesNotDependOnItsOwnByte) {
  std::array<std::byte, 8> payload{};
  payload[0] = std::byte{0x5A};
  EXPECT_EQ(dbc::E2eProfile1Crc(0x123, payload), 0xCC);
}

TEST(E2eProfile1, EveryFlippedBitChangesTheCrc) {
  std::array<std::byte, 8> payload{};
  for (std::size_t bit = 8; bit < 64; ++bit) {
    std::array<std::byte, 8> flipped = payload;
    flipped[bit / 8] ^= std::byte{1} << (bit % 8);
    EXPECT_NE(dbc::E2eProfile1Crc(0x123, flipped), dbc::E2eProfile1Crc(0x123, payload)) << "bit " << bit;
  }
}

TEST(E2eCounter, GoesFrom0To14AndNever15) {
  std::uint8_t counter = 0;
  for (int expected = 0; expected < 100; ++expected) {
    ASSERT_EQ(counter, expected % 15);
    counter = dbc::NextCounter(counter);
  }
}

}  // namespace
