// Reads those parts of DBC statements that need no knowledge of the rest of the file, from the present place of a
// TokenReader.
#pragma once

#include <string>

#include "dbc/database.hpp"
#include "dbc/token_reader.hpp"

namespace dbc {

// Skips the words after NS_, most of which are keywords: the list ends where one is used as a keyword.
void SkipNewSymbols(TokenReader& in);
// Skips the numbers after BS_.
void SkipBitTiming(TokenReader& in);

struct SignalStatement {
  Signal signal;  // its multiplexor is not known yet
  Token place;
};

// Reads the rest of a statement after SG_.
[[nodiscard]] SignalStatement ReadSignal(TokenReader& in);

// The part of SG_MUL_VAL_ after the message id and the signal name: the name of a multiplexor and `first-last,
// first-last;`.
struct MultiplexedValues {
  std::string multiplexor;
  std::vector<RawRange> values;
};
[[nodiscard]] MultiplexedValues ReadMultiplexedValues(TokenReader& in);

// Reads pairs of value and text up to and including the ';'.
[[nodiscard]] ValueTable ReadValues(TokenReader& in);

// Reads the rest of BA_DEF_ after the name of the attribute, including the ';'.
[[nodiscard]] AttributeDefinition ReadAttributeType(TokenReader& in);

// Reads the value of an attribute, in the type of its definition; as written if `definition` is nullptr or does
// not fit.
[[nodiscard]] AttributeValue ReadAttributeValue(TokenReader& in, const AttributeDefinition* definition);

}  // namespace dbc
