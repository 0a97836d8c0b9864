#include "dbc/codec.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace dbc {
namespace {

// The part of a signal in one byte.
struct Piece {
  std::size_t byte = 0;
  unsigned shift = 0;      // index of its lowest bit in the byte
  unsigned width = 0;      // [bits]
  unsigned raw_shift = 0;  // index of its lowest bit in the raw value

  [[nodiscard]] std::uint8_t Mask() const {
    return static_cast<std::uint8_t>((0xFFu >> (8 - width)) << shift);
  }
};

// Intel signals begin with their lowest bits and fill bytes upwards; Motorola signals begin with their
// highest bits and fill bytes downwards. Both continue in the next byte.
template <typename Visit>
void ForEachPiece(const Signal& signal, Visit&& visit) {
  std::size_t byte = signal.start_bit / 8;
  unsigned bit = signal.start_bit % 8;
  unsigned left = signal.length;
  while (left > 0) {
    if (signal.byte_order == ByteOrder::kIntel) {
      const unsigned width = std::min(8 - bit, left);
      visit(Piece{byte, bit, width, signal.length - left});
      left -= width;
      bit = 0;
    } else {
      const unsigned width = std::min(bit + 1, left);
      left -= width;
      visit(Piece{byte, bit + 1 - width, width, left});
      bit = 7;
    }
    ++byte;
  }
}

std::uint64_t LowBits(unsigned length) {
  return ~std::uint64_t{0} >> (64 - length);
}

bool IsFloat(const Signal& signal) {
  return signal.type == ValueType::kFloat32 || signal.type == ValueType::kFloat64;
}

// The bits of the integer nearest to `scaled` among those that the signal can hold.
std::uint64_t ToInteger(const Signal& signal, double scaled, bool& saturated) {
  const bool is_signed = signal.type == ValueType::kSigned;
  const double rounded = std::round(scaled);
  const double end =
      std::ldexp(1.0, static_cast<int>(signal.length) - (is_signed ? 1 : 0));  // first value too large
  const double lowest = is_signed ? -end : 0.0;
  const std::uint64_t highest = LowBits(signal.length) >> (is_signed ? 1 : 0);
  if (rounded >= end) {
    saturated = true;
    return highest;
  }
  if (rounded < lowest) {
    saturated = true;
    return is_signed ? highest + 1 : 0;
  }
  return is_signed ? static_cast<std::uint64_t>(static_cast<std::int64_t>(rounded))
                   : static_cast<std::uint64_t>(rounded);
}

std::uint64_t ToFloat(const Signal& signal, double scaled, bool& saturated) {
  const double largest = signal.type == ValueType::kFloat32 ? std::numeric_limits<float>::max()
                                                            : std::numeric_limits<double>::max();
  const double held = std::clamp(scaled, -largest, largest);
  saturated = saturated || held != scaled;
  return signal.type == ValueType::kFloat32 ? std::bit_cast<std::uint32_t>(static_cast<float>(held))
                                            : std::bit_cast<std::uint64_t>(held);
}

std::uint64_t ToRaw(const Signal& signal, double value, bool& saturated) {
  const double scaled = (value - signal.offset) / signal.factor;
  return IsFloat(signal) ? ToFloat(signal, scaled, saturated) : ToInteger(signal, scaled, saturated);
}

}  // namespace

bool Fits(const Signal& signal, std::size_t payload_bytes) {
  const std::size_t byte = signal.start_bit / 8;
  const std::size_t skipped =
      signal.byte_order == ByteOrder::kIntel ? signal.start_bit % 8 : 7 - signal.start_bit % 8;
  return byte + (skipped + signal.length + 7) / 8 <= payload_bytes;
}

std::uint64_t ReadRaw(const Signal& signal, std::span<const std::byte> payload) {
  assert(Fits(signal, payload.size()));
  std::uint64_t raw = 0;
  ForEachPiece(signal, [&](const Piece& piece) {
    const unsigned bits = std::to_integer<unsigned>(payload[piece.byte]) & piece.Mask();
    raw |= static_cast<std::uint64_t>(bits >> piece.shift) << piece.raw_shift;
  });
  return raw;
}

void WriteRaw(const Signal& signal, std::uint64_t raw, std::span<std::byte> payload) {
  assert(Fits(signal, payload.size()));
  ForEachPiece(signal, [&](const Piece& piece) {
    const std::byte mask{piece.Mask()};
    const std::byte bits{static_cast<std::uint8_t>(((raw >> piece.raw_shift) & 0xFFu) << piece.shift)};
    payload[piece.byte] = (payload[piece.byte] & ~mask) | (bits & mask);
  });
}

std::int64_t ReadInteger(const Signal& signal, std::span<const std::byte> payload) {
  const std::uint64_t raw = ReadRaw(signal, payload);
  const bool negative = signal.type == ValueType::kSigned && ((raw >> (signal.length - 1)) & 1u) != 0;
  return static_cast<std::int64_t>(negative ? raw | ~LowBits(signal.length) : raw);
}

double DecodeSignal(const Signal& signal, std::span<const std::byte> payload) {
  double raw = 0.0;
  switch (signal.type) {
    case ValueType::kUnsigned:
      raw = static_cast<double>(ReadRaw(signal, payload));
      break;
    case ValueType::kSigned:
      raw = static_cast<double>(ReadInteger(signal, payload));
      break;
    case ValueType::kFloat32:
      raw = std::bit_cast<float>(static_cast<std::uint32_t>(ReadRaw(signal, payload)));
      break;
    case ValueType::kFloat64:
      raw = std::bit_cast<double>(ReadRaw(signal, payload));
      break;
  }
  return raw * signal.factor + signal.offset;
}

EncodeStatus EncodeSignal(const Signal& signal, double value, std::span<std::byte> payload) {
  if (!std::isfinite(value)) return EncodeStatus::kNotFinite;
  const double held = signal.HasRange() ? std::clamp(value, signal.min, signal.max) : value;
  bool saturated = held != value;
  WriteRaw(signal, ToRaw(signal, held, saturated), payload);
  return saturated ? EncodeStatus::kSaturated : EncodeStatus::kOk;
}

bool InRange(const Signal& signal, std::span<const std::byte> payload) {
  const double value = DecodeSignal(signal, payload);
  if (!std::isfinite(value)) return false;
  if (!signal.HasRange() || (signal.min <= value && value <= signal.max)) return true;
  // An end of the range, rounded to what the signal can hold, may be outside the range.
  bool saturated = false;
  return ReadRaw(signal, payload) == ToRaw(signal, std::clamp(value, signal.min, signal.max), saturated);
}

bool IsPresent(const MessageDefinition& message, const Signal& signal, std::span<const std::byte> payload) {
  for (const Signal* s = &signal; s->multiplexing;) {
    const Signal& multiplexor = message.signals[s->multiplexing->multiplexor];
    const std::uint64_t raw = ReadRaw(multiplexor, payload);
    const auto holds = [raw](const RawRange& range) { return range.first <= raw && raw <= range.last; };
    if (std::ranges::none_of(s->multiplexing->values, holds)) return false;
    s = &multiplexor;
  }
  return true;
}

const std::string* ValueText(const Signal& signal, std::span<const std::byte> payload) {
  if (signal.values.empty() || IsFloat(signal)) return nullptr;
  const auto found = signal.values.find(ReadInteger(signal, payload));
  return found == signal.values.end() ? nullptr : &found->second;
}

}  // namespace dbc
