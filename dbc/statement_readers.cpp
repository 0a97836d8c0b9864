#include "dbc/statement_readers.hpp"

#include <charconv>
#include <limits>

#include "dbc/codec.hpp"

namespace dbc {
namespace {

constexpr std::uint64_t kMaxBit = 8 * kMaxMessageLength - 1;
constexpr std::uint64_t kMaxRaw = std::numeric_limits<std::uint64_t>::max();

// Reads `M`, `m3`, `m3M`, or a lone `m` whose values SG_MUL_VAL_ lists.
void ReadMultiplexor(TokenReader& in, Signal& signal) {
  std::string_view text = in.Peek().text;
  if (text.starts_with('m')) {
    text.remove_prefix(1);
    Multiplexing& multiplexing = signal.multiplexing.emplace();
    std::uint64_t value = 0;
    const auto [stopped, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{}) multiplexing.values.push_back({value, value});
    text.remove_prefix(static_cast<std::size_t>(stopped - text.data()));
  }
  signal.is_multiplexor = text == "M";
  const bool understood = signal.is_multiplexor || (text.empty() && signal.multiplexing);
  if (!understood) in.FailExpected("':' or a multiplexor such as M, m0 or m0M after the signal name");
  in.Take();
}

void ReadLayout(TokenReader& in, Signal& signal) {
  signal.start_bit = static_cast<unsigned>(in.Unsigned("the start bit", kMaxBit));
  in.Expect("|", "the start bit");
  const Token length = in.Peek();
  signal.length = static_cast<unsigned>(in.Unsigned("the length of the signal in bits", kMaxBit + 1));
  if (signal.length < 1 || signal.length > 64) {
    in.Fail(length, "signal " + signal.name + " has " + length.text + " bits, expected 1 to 64");
  }
  in.Expect("@", "the length of the signal");
  const bool intel = in.Unsigned("the byte order, 0 = Motorola or 1 = Intel", 1) == 1;
  signal.byte_order = intel ? ByteOrder::kIntel : ByteOrder::kMotorola;
  if (!in.At("+") && !in.At("-")) in.FailExpected("'+' (unsigned) or '-' (signed) after the byte order");
  signal.type = in.Take().text == "-" ? ValueType::kSigned : ValueType::kUnsigned;
}

void ReadScaling(TokenReader& in, Signal& signal) {
  in.Expect("(", "the sign of the signal");
  const Token factor = in.Peek();
  signal.factor = in.Real("the factor");
  if (signal.factor == 0.0)
    in.Fail(factor, "signal " + signal.name + " has the factor 0, expected any other");
  in.Expect(",", "the factor");
  signal.offset = in.Real("the offset");
  in.Expect(")", "the offset");
  in.Expect("[", "the factor and offset");
  signal.min = in.Real("the minimum");
  in.Expect("|", "the minimum");
  signal.max = in.Real("the maximum");
  in.Expect("]", "the maximum");
}

}  // namespace

void SkipNewSymbols(TokenReader& in) {
  in.Expect(":", "NS_");
  while (in.AtIdentifier() && !in.At("BS_") && !in.At("BU_") && !in.At("BO_") &&
         (in.Peek(1).kind == Token::Kind::kIdentifier || in.Peek(1).kind == Token::Kind::kEnd)) {
    in.Take();
  }
}

void SkipBitTiming(TokenReader& in) {
  in.Expect(":", "BS_");
  while (in.Peek().kind == Token::Kind::kNumber || in.At(":") || in.At(",")) in.Take();
}

SignalStatement ReadSignal(TokenReader& in) {
  SignalStatement statement;
  Signal& signal = statement.signal;
  statement.place = in.Peek();
  signal.name = in.Name("a signal name").text;
  if (in.AtIdentifier()) ReadMultiplexor(in, signal);
  in.Expect(":", "the signal name");
  ReadLayout(in, signal);
  ReadScaling(in, signal);
  signal.unit = in.String("the unit").text;
  while (in.AtName()) {
    signal.receivers.push_back(in.Take().text);
    in.TakeIf(",");
  }
  return statement;
}

MultiplexedValues ReadMultiplexedValues(TokenReader& in) {
  MultiplexedValues statement;
  statement.multiplexor = in.Name("the name of a multiplexor").text;
  do {
    RawRange range;
    range.first = in.Unsigned("the first value of a range", kMaxRaw);
    in.Expect("-", "the first value of a range");
    range.last = in.Unsigned("the last value of a range", kMaxRaw);
    statement.values.push_back(range);
  } while (in.TakeIf(","));
  in.Expect(";", "the last range of values");
  return statement;
}

ValueTable ReadValues(TokenReader& in) {
  ValueTable values;
  while (!in.TakeIf(";")) {
    const std::int64_t value = in.Integer("';' or a value of the table");
    values.insert_or_assign(value, in.String("the text of the value").text);
  }
  return values;
}

AttributeDefinition ReadAttributeType(TokenReader& in) {
  AttributeDefinition definition;
  if (in.TakeIf("ENUM")) {
    definition.type = AttributeType::kEnumeration;
    while (!in.At(";")) {
      definition.choices.push_back(in.String("';' or a choice of the attribute").text);
      in.TakeIf(",");
    }
  } else if (!in.TakeIf("STRING")) {
    if (in.TakeIf("INT")) {
      definition.type = AttributeType::kInteger;
    } else if (in.TakeIf("HEX")) {
      definition.type = AttributeType::kHex;
    } else if (in.TakeIf("FLOAT")) {
      definition.type = AttributeType::kFloat;
    } else {
      in.FailExpected("the type of the attribute: INT, HEX, FLOAT, STRING or ENUM");
    }
    if (!in.At(";")) {
      definition.min = in.Real("the minimum");
      definition.max = in.Real("the maximum");
    }
  }
  in.Expect(";", "the definition of the attribute");
  return definition;
}

AttributeValue ReadAttributeValue(TokenReader& in, const AttributeDefinition* definition) {
  if (in.Peek().kind == Token::Kind::kString) return in.Take().text;
  const bool wants_real = definition != nullptr && definition->type == AttributeType::kFloat;
  if (wants_real || !in.AtInteger()) return in.Real("the value of the attribute: a text in quotes or");
  const std::int64_t value = in.Integer("the value of the attribute");
  const bool is_choice =
      definition != nullptr && value >= 0 && static_cast<std::uint64_t>(value) < definition->choices.size();
  if (is_choice) return definition->choices[static_cast<std::size_t>(value)];
  return value;
}

}  // namespace dbc
