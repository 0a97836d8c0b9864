// Signals in and out of payload bytes. Every function takes a payload that holds the whole signal: Fits()
// says whether it does, and each asserts it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "dbc/database.hpp"

namespace dbc {

enum class EncodeStatus : std::uint8_t {
  kOk,
  kSaturated,  // the value lay outside the signal's range: the nearest value that it holds was written
  kNotFinite,  // NaN or infinite: nothing was written
};

[[nodiscard]] bool Fits(const Signal& signal, std::size_t payload_bytes);

// The signal's bits as an unsigned integer, and back. WriteRaw uses the lower `length` bits of `raw` and
// touches only the signal's own bits.
[[nodiscard]] std::uint64_t ReadRaw(const Signal& signal, std::span<const std::byte> payload);
void WriteRaw(const Signal& signal, std::uint64_t raw, std::span<std::byte> payload);

// Raw value with the sign of a kSigned signal. Exact for 64 bits; of an unsigned one above the largest int64,
// and of a float, it is the bit pattern.
[[nodiscard]] std::int64_t ReadInteger(const Signal& signal, std::span<const std::byte> payload);

// Physical value. May be NaN or infinite where the signal is a float; more than 53 bits are rounded.
[[nodiscard]] double DecodeSignal(const Signal& signal, std::span<const std::byte> payload);

// Rounds to the nearest raw value, half away from zero; saturates to [min|max] where the signal has one, and
// to what its bits hold. (Where min or max is no multiple of the factor the result may pass it by half a
// factor.)
[[nodiscard]] EncodeStatus EncodeSignal(const Signal& signal, double value, std::span<std::byte> payload);

// False if the value is not finite or lies outside [min|max] where the signal has one. What EncodeSignal writes is
// in range, rounded as it is.
[[nodiscard]] bool InRange(const Signal& signal, std::span<const std::byte> payload);

// False for a multiplexed signal whose multiplexor, itself present, says that other signals stand in the
// payload.
[[nodiscard]] bool IsPresent(const MessageDefinition& message, const Signal& signal,
                             std::span<const std::byte> payload);

// Text of the raw value in the signal's value table; nullptr if it has none.
[[nodiscard]] const std::string* ValueText(const Signal& signal, std::span<const std::byte> payload);

}  // namespace dbc
