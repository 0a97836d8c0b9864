// Decodes signals from payload bytes and encodes them. Every function requires a payload that holds the whole
// signal, as Fits() checks and each function asserts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "dbc/database.hpp"

namespace dbc {

enum class EncodeStatus : std::uint8_t {
  kOk,
  kSaturated,  // the value was outside the signal's range: the nearest possible value was written
  kNotFinite,  // NaN or infinite: nothing was written
};

[[nodiscard]] bool Fits(const Signal& signal, std::size_t payload_bytes);

// Reads and writes the signal's bits as an unsigned integer. WriteRaw uses the lower `length` bits of `raw` and
// changes only the signal's own bits.
[[nodiscard]] std::uint64_t ReadRaw(const Signal& signal, std::span<const std::byte> payload);
void WriteRaw(const Signal& signal, std::uint64_t raw, std::span<std::byte> payload);

// The raw value, with the sign of a kSigned signal; exact for 64 bits. An unsigned value above the largest int64, and
// a float, is returned as its bit pattern.
[[nodiscard]] std::int64_t ReadInteger(const Signal& signal, std::span<const std::byte> payload);

// The physical value. It may be NaN or infinite if the signal is a float; more than 53 bits are rounded.
[[nodiscard]] double DecodeSignal(const Signal& signal, std::span<const std::byte> payload);

// Writes the nearest raw value (ties are rounded away from zero), saturated to [min|max] if the signal has a
// range, and to what its bits hold. (If min or max is not a multiple of the factor, the result may exceed it by
// half a factor.)
[[nodiscard]] EncodeStatus EncodeSignal(const Signal& signal, double value, std::span<std::byte> payload);

// False if the value is not finite or is outside [min|max], if the signal has a range. Whatever EncodeSignal writes
// is in range, even where rounding exceeds an end.
[[nodiscard]] bool InRange(const Signal& signal, std::span<const std::byte> payload);

// False for a multiplexed signal if the value of its multiplexor, or of a multiplexor of that one, selects other
// signals.
[[nodiscard]] bool IsPresent(const MessageDefinition& message, const Signal& signal,
                             std::span<const std::byte> payload);

// The text of the raw value in the signal's value table; nullptr if there is none, or the signal is a float.
[[nodiscard]] const std::string* ValueText(const Signal& signal, std::span<const std::byte> payload);

}  // namespace dbc
