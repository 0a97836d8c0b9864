#include "dbc/codec.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

namespace {

using dbc::ByteOrder;
using dbc::EncodeStatus;
using dbc::Signal;
using dbc::ValueType;
using Payload = std::array<std::byte, 8>;

// The numbers of a signal's bits in the payload (bit % 8 of byte bit / 8), the most significant one first, as
// the DBC format defines them: written without any arithmetic that the codec uses.
std::vector<unsigned> BitsFromTheTop(const Signal& signal) {
  std::vector<unsigned> bits;
  if (signal.byte_order == ByteOrder::kIntel) {
    for (unsigned i = signal.length; i-- > 0;) bits.push_back(signal.start_bit + i);
  } else {
    unsigned bit = signal.start_bit;
    for (unsigned i = 0; i < signal.length; ++i) {
      bits.push_back(bit);
      bit = bit % 8 == 0 ? bit + 15 : bit - 1;  // bit 0 of a byte is followed by bit 7 of the next
    }
  }
  return bits;
}

bool GetBit(const Payload& payload, unsigned bit) {
  return (std::to_integer<unsigned>(payload.at(bit / 8)) >> (bit % 8) & 1u) != 0;
}

std::uint64_t OracleRaw(const Signal& signal, const Payload& payload) {
  std::uint64_t raw = 0;
  for (const unsigned bit : BitsFromTheTop(signal)) raw = raw * 2 + (GetBit(payload, bit) ? 1 : 0);
  return raw;
}

Payload RandomPayload(std::mt19937_64& random) {
  const std::uint64_t bits = random();
  return std::bit_cast<Payload>(bits);
}

// Every layout that fits into eight bytes.
template <typename Visit>
void ForEachLayout(Visit&& visit) {
  for (const ByteOrder order : {ByteOrder::kIntel, ByteOrder::kMotorola}) {
    for (const ValueType type : {ValueType::kUnsigned, ValueType::kSigned}) {
      for (unsigned start = 0; start < 64; ++start) {
        for (unsigned length = 1; length <= 64; ++length) {
          Signal signal;
          signal.byte_order = order;
          signal.type = type;
          signal.start_bit = start;
          signal.length = length;
          if (dbc::Fits(signal, 8)) visit(signal);
        }
      }
    }
  }
}

Signal Make(unsigned length, ValueType type, double factor = 1.0, double offset = 0.0) {
  Signal signal;
  signal.length = length;
  signal.type = type;
  signal.factor = factor;
  signal.offset = offset;
  return signal;
}

TEST(Codec, FitsExactlyWhereEveryBitIsInThePayload) {
  for (const ByteOrder order : {ByteOrder::kIntel, ByteOrder::kMotorola}) {
    for (unsigned start = 0; start < 80; ++start) {
      for (unsigned length = 1; length <= 64; ++length) {
        Signal signal = Make(length, ValueType::kUnsigned);
        signal.byte_order = order;
        signal.start_bit = start;
        bool inside = true;
        for (const unsigned bit : BitsFromTheTop(signal)) inside = inside && bit < 64;
        ASSERT_EQ(dbc::Fits(signal, 8), inside) << start << '|' << length;
      }
    }
  }
}

TEST(Codec, ReadsTheBitsThatTheFormatNames) {
  std::mt19937_64 random(1);
  ForEachLayout([&](const Signal& signal) {
    const Payload payload = RandomPayload(random);
    ASSERT_EQ(dbc::ReadRaw(signal, payload), OracleRaw(signal, payload))
        << signal.start_bit << '|' << signal.length;
  });
}

TEST(Codec, WritesItsOwnBitsAndNoOther) {
  std::mt19937_64 random(2);
  ForEachLayout([&](const Signal& signal) {
    const Payload before = RandomPayload(random);
    const std::uint64_t raw = random();
    Payload after = before;
    dbc::WriteRaw(signal, raw, after);
    const std::uint64_t low_bits =
        signal.length == 64 ? raw : raw & ((std::uint64_t{1} << signal.length) - 1);
    ASSERT_EQ(OracleRaw(signal, after), low_bits);
    std::array<bool, 64> own{};
    for (const unsigned bit : BitsFromTheTop(signal)) own.at(bit) = true;
    for (unsigned bit = 0; bit < 64; ++bit) {
      if (own.at(bit)) continue;
      ASSERT_EQ(GetBit(after, bit), GetBit(before, bit)) << "bit " << bit;
    }
  });
}

TEST(Codec, EncodedValueComesBackWithinHalfAFactor) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  ForEachLayout([&](Signal signal) {
    signal.factor = std::ldexp(1.0 + unit(random), static_cast<int>(random() % 40) - 30);
    if (random() % 4 == 0) signal.factor = -signal.factor;
    signal.offset = (unit(random) - 0.5) * 1000.0;
    const double span = std::ldexp(1.0, static_cast<int>(signal.length));
    const double lowest = signal.type == ValueType::kSigned ? -span / 2 : 0.0;
    const double scaled = lowest + unit(random) * (span - 1.0);
    const double value = scaled * signal.factor + signal.offset;
    Payload payload = RandomPayload(random);
    ASSERT_NE(dbc::EncodeSignal(signal, value, payload), EncodeStatus::kNotFinite);
    const double rounding = 8.0 * std::numeric_limits<double>::epsilon() *
                            (std::abs(value) + std::abs(signal.offset) + std::abs(signal.factor));
    ASSERT_NEAR(dbc::DecodeSignal(signal, payload), value, std::abs(signal.factor) * 0.5 + rounding)
        << signal.start_bit << '|' << signal.length;
  });
}

TEST(Codec, DecodedValueEncodesToTheSameBits) {
  std::mt19937_64 random(4);
  ForEachLayout([&](Signal signal) {
    if (signal.length > 50) return;  // a double holds no more bits
    signal.factor = 0.001;
    signal.offset = -40.0;
    const Payload before = RandomPayload(random);
    Payload after = before;
    ASSERT_EQ(dbc::EncodeSignal(signal, dbc::DecodeSignal(signal, before), after), EncodeStatus::kOk);
    ASSERT_EQ(after, before);
  });
}

TEST(Codec, ValueBeyondTheBitsSaturatesToTheNearestThatTheyHold) {
  ForEachLayout([](const Signal& signal) {
    const bool is_signed = signal.type == ValueType::kSigned;
    const std::uint64_t all =
        signal.length == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << signal.length) - 1;
    for (const double huge : {1e20, std::numeric_limits<double>::max()}) {
      Payload payload{};
      ASSERT_EQ(dbc::EncodeSignal(signal, huge, payload), EncodeStatus::kSaturated);
      ASSERT_EQ(dbc::ReadRaw(signal, payload), is_signed ? all >> 1 : all);
      ASSERT_EQ(dbc::EncodeSignal(signal, -huge, payload), EncodeStatus::kSaturated);
      ASSERT_EQ(dbc::ReadRaw(signal, payload), is_signed ? (all >> 1) + 1 : 0);
    }
  });
}

TEST(Codec, HugeValueOverATinyFactorSaturatesToo) {
  Payload payload{};
  const Signal signal = Make(16, ValueType::kSigned, 1e-300);
  EXPECT_EQ(dbc::EncodeSignal(signal, 1e300, payload), EncodeStatus::kSaturated);
  EXPECT_EQ(dbc::ReadInteger(signal, payload), 32767);
  EXPECT_EQ(dbc::EncodeSignal(signal, -1e300, payload), EncodeStatus::kSaturated);
  EXPECT_EQ(dbc::ReadInteger(signal, payload), -32768);
}

TEST(Codec, ValueBeyondTheRangeSaturatesToTheRange) {
  Signal signal = Make(16, ValueType::kSigned, 0.01);
  signal.min = -1.0;
  signal.max = 2.0;
  Payload payload{};
  EXPECT_EQ(dbc::EncodeSignal(signal, 2.01, payload), EncodeStatus::kSaturated);
  EXPECT_DOUBLE_EQ(dbc::DecodeSignal(signal, payload), 2.0);
  EXPECT_EQ(dbc::EncodeSignal(signal, -7.0, payload), EncodeStatus::kSaturated);
  EXPECT_DOUBLE_EQ(dbc::DecodeSignal(signal, payload), -1.0);
  EXPECT_EQ(dbc::EncodeSignal(signal, 2.0, payload), EncodeStatus::kOk);
}

TEST(Codec, RangeOfZeroToZeroAndMinAboveMaxAreNoRange) {
  Signal signal = Make(8, ValueType::kUnsigned);
  Payload payload{};
  EXPECT_EQ(dbc::EncodeSignal(signal, 200.0, payload), EncodeStatus::kOk);
  signal.min = 10.0;
  signal.max = -10.0;
  EXPECT_EQ(dbc::EncodeSignal(signal, 200.0, payload), EncodeStatus::kOk);
  EXPECT_EQ(dbc::ReadRaw(signal, payload), 200u);
}

TEST(Codec, EveryValueBeyondTheRangeIsOutOfRangeAndNoOther) {
  for (const double offset : {0.0, -0.5}) {
    Signal signal = Make(16, ValueType::kSigned, 0.01, offset);
    signal.min = -1.0;
    signal.max = 2.0;
    Payload payload{};
    const int from = static_cast<int>(std::lround((signal.min - offset) * 100.0));
    const int to = static_cast<int>(std::lround((signal.max - offset) * 100.0));
    for (int raw = -32768; raw < 32768; ++raw) {
      dbc::WriteRaw(signal, static_cast<std::uint64_t>(raw), payload);
      ASSERT_EQ(dbc::InRange(signal, payload), from <= raw && raw <= to) << raw;
    }
  }
}

TEST(Codec, EndOfTheRangeThatTheBitsDoNotHoldExactlyIsInRangeAsItIsEncoded) {
  Signal integer = Make(8, ValueType::kUnsigned, 0.3);
  integer.max = 1.1;  // encoded as 1.2
  Signal real = Make(32, ValueType::kFloat32);
  real.max = 0.1;  // a float32 holds a little more
  Payload payload{};
  for (const Signal& signal : {integer, real}) {
    EXPECT_EQ(dbc::EncodeSignal(signal, 99.0, payload), EncodeStatus::kSaturated);
    EXPECT_GT(dbc::DecodeSignal(signal, payload), signal.max);
    EXPECT_TRUE(dbc::InRange(signal, payload));
    dbc::WriteRaw(signal, dbc::ReadRaw(signal, payload) + 1, payload);
    EXPECT_FALSE(dbc::InRange(signal, payload));
  }
}

TEST(Codec, WithoutARangeEveryNumberIsInRangeAndNothingElse) {
  Payload payload{};
  const Signal real = Make(64, ValueType::kFloat64);
  dbc::WriteRaw(real, std::bit_cast<std::uint64_t>(-1e300), payload);
  EXPECT_TRUE(dbc::InRange(real, payload));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    dbc::WriteRaw(real, std::bit_cast<std::uint64_t>(bad), payload);
    EXPECT_FALSE(dbc::InRange(real, payload));
  }
}

TEST(Codec, NotANumberAndInfinityWriteNothing) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const ValueType type :
       {ValueType::kUnsigned, ValueType::kSigned, ValueType::kFloat32, ValueType::kFloat64}) {
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
      Payload payload;
      payload.fill(std::byte{0xA5});
      const Payload before = payload;
      const unsigned length = type == ValueType::kFloat64 ? 64 : 32;
      EXPECT_EQ(dbc::EncodeSignal(Make(length, type), value, payload), EncodeStatus::kNotFinite);
      EXPECT_EQ(payload, before);
    }
  }
}

TEST(Codec, IntegersOf64BitsAreExact) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 1000; ++i) {
    Payload payload{};
    const std::uint64_t raw = random();
    const Signal is_signed = Make(64, ValueType::kSigned);
    dbc::WriteRaw(is_signed, raw, payload);
    EXPECT_EQ(dbc::ReadRaw(is_signed, payload), raw);
    EXPECT_EQ(dbc::ReadInteger(is_signed, payload), static_cast<std::int64_t>(raw));
  }
}

TEST(Codec, LargestValuesOf64BitsDoNotWrapRound) {
  Payload payload{};
  EXPECT_EQ(dbc::EncodeSignal(Make(64, ValueType::kUnsigned), 0x1p64, payload), EncodeStatus::kSaturated);
  EXPECT_EQ(dbc::ReadRaw(Make(64, ValueType::kUnsigned), payload), ~std::uint64_t{0});
  EXPECT_EQ(dbc::EncodeSignal(Make(64, ValueType::kSigned), 0x1p63, payload), EncodeStatus::kSaturated);
  EXPECT_EQ(dbc::ReadInteger(Make(64, ValueType::kSigned), payload),
            std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(dbc::EncodeSignal(Make(64, ValueType::kSigned), -0x1p63, payload), EncodeStatus::kOk);
  EXPECT_EQ(dbc::ReadInteger(Make(64, ValueType::kSigned), payload),
            std::numeric_limits<std::int64_t>::min());
}

TEST(Codec, FloatsStandInTheirIeeeBitsInBothByteOrders) {
  Signal signal = Make(32, ValueType::kFloat32);
  Payload payload{};
  ASSERT_EQ(dbc::EncodeSignal(signal, -1.5, payload), EncodeStatus::kOk);
  EXPECT_EQ(dbc::ReadRaw(signal, payload), 0xBFC00000u);
  EXPECT_EQ(payload[3], std::byte{0xBF});
  EXPECT_EQ(dbc::DecodeSignal(signal, payload), -1.5);
  signal.byte_order = ByteOrder::kMotorola;
  signal.start_bit = 7;
  ASSERT_EQ(dbc::EncodeSignal(signal, -1.5, payload), EncodeStatus::kOk);
  EXPECT_EQ(payload[0], std::byte{0xBF});
  EXPECT_EQ(dbc::DecodeSignal(signal, payload), -1.5);

  signal = Make(64, ValueType::kFloat64, 2.0, 1.0);
  ASSERT_EQ(dbc::EncodeSignal(signal, 0.1, payload), EncodeStatus::kOk);
  EXPECT_DOUBLE_EQ(dbc::DecodeSignal(signal, payload), 0.1);
}

TEST(Codec, ValueBeyondAFloatSaturatesToTheLargestFloat) {
  const Signal signal = Make(32, ValueType::kFloat32);
  Payload payload{};
  EXPECT_EQ(dbc::EncodeSignal(signal, 1e300, payload), EncodeStatus::kSaturated);
  EXPECT_EQ(dbc::DecodeSignal(signal, payload), std::numeric_limits<float>::max());
  EXPECT_EQ(dbc::EncodeSignal(signal, -1e300, payload), EncodeStatus::kSaturated);
  EXPECT_EQ(dbc::DecodeSignal(signal, payload), std::numeric_limits<float>::lowest());
}

TEST(Codec, SignalOfMoreThanEightBytesOfPayloadIsReachedInFdFrames) {
  Signal signal = Make(64, ValueType::kUnsigned);
  signal.start_bit = 8 * 55 + 3;  // spans nine bytes
  std::array<std::byte, 64> payload{};
  ASSERT_TRUE(dbc::Fits(signal, payload.size()));
  dbc::WriteRaw(signal, 0x8123456789ABCDEFu, payload);
  EXPECT_EQ(dbc::ReadRaw(signal, payload), 0x8123456789ABCDEFu);
}

}  // namespace
