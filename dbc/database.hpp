// The contents of a DBC file: messages, their signals, value tables, attributes, comments.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace dbc {

// kIntel (`@1`): start_bit is the least significant bit; the signal continues towards higher bit numbers.
// kMotorola (`@0`): start_bit is the most significant bit; the signal continues towards bit 0 of the same byte,
// then from bit 7 of the next byte. In both, bit b of a payload is bit b % 8 of byte b / 8, where bit 0 is the
// least significant.
enum class ByteOrder : std::uint8_t { kIntel, kMotorola };

enum class ValueType : std::uint8_t {
  kUnsigned,
  kSigned,   // two's complement
  kFloat32,  // IEEE 754, 32 bits long
  kFloat64,  // IEEE 754, 64 bits long
};

using AttributeValue = std::variant<std::int64_t, double, std::string>;
using Attributes = std::map<std::string, AttributeValue, std::less<>>;

// Maps raw values to texts. A value above the largest int64 is stored as its bit pattern.
using ValueTable = std::map<std::int64_t, std::string>;

struct RawRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;  // inclusive
};

// The signal is in the payload while its multiplexor's raw value is in one of `values`.
struct Multiplexing {
  std::size_t multiplexor = 0;   // index in MessageDefinition::signals
  std::vector<RawRange> values;  // one value in simple multiplexing; empty: the signal is never present
};

// The longest message, that of the J1939 transport protocol [bytes].
inline constexpr unsigned kMaxMessageLength = 1785;

// physical = raw * factor + offset
struct Signal {
  std::string name;
  unsigned start_bit = 0;
  unsigned length = 1;  // 1..64 bits
  ByteOrder byte_order = ByteOrder::kIntel;
  ValueType type = ValueType::kUnsigned;
  double factor = 1.0;  // finite, not 0
  double offset = 0.0;
  double min = 0.0;  // physical
  double max = 0.0;
  std::string unit;
  std::vector<std::string> receivers;
  bool is_multiplexor = false;
  std::optional<Multiplexing> multiplexing;  // none: always present
  ValueTable values;
  Attributes attributes;
  std::string comment;

  // Files write [0|0], or min > max, to mean no range.
  [[nodiscard]] bool HasRange() const { return min < max; }
};

struct MessageDefinition {
  std::uint32_t id = 0;  // without bit 31 of the DBC id
  bool extended = false;
  std::string name;
  unsigned length = 0;  // [bytes]
  std::string transmitter;
  std::vector<Signal> signals;
  Attributes attributes;
  std::string comment;

  [[nodiscard]] const Signal* Find(std::string_view signal_name) const;
};

enum class AttributeType : std::uint8_t { kInteger, kHex, kFloat, kString, kEnumeration };

struct AttributeDefinition {
  std::string object;  // "BU_", "BO_", "SG_", "EV_"; empty: the network
  AttributeType type = AttributeType::kString;
  double min = 0.0;
  double max = 0.0;
  std::vector<std::string> choices;  // values of an enumeration
  std::optional<AttributeValue> default_value;
};

struct Node {
  std::string name;
  Attributes attributes;
  std::string comment;
};

struct Database {
  std::string source;  // name of the file
  std::string version;
  std::vector<Node> nodes;
  std::vector<MessageDefinition> messages;
  std::map<std::string, ValueTable, std::less<>> value_tables;
  std::map<std::string, AttributeDefinition, std::less<>> attribute_definitions;
  Attributes attributes;
  std::string comment;
  // "FILE:LINE:COLUMN: ...": harmless oddities of real files.
  std::vector<std::string> warnings;

  [[nodiscard]] const MessageDefinition* Find(std::string_view message_name) const;
  [[nodiscard]] const MessageDefinition* Find(std::uint32_t id, bool extended) const;
  // The message's own attribute, else the default of the definition, else nullptr.
  [[nodiscard]] const AttributeValue* Attribute(const MessageDefinition& message,
                                                std::string_view name) const;
};

// The number that an attribute holds; nullopt if it holds text.
[[nodiscard]] std::optional<double> Number(const AttributeValue& value);

}  // namespace dbc
