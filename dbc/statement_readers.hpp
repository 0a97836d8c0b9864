// The parts of DBC statements that stand on their own: what a TokenReader gives at its place, without a look
// at the rest of the file.
#pragma once

#include <string>

#include "dbc/database.hpp"
#include "dbc/token_reader.hpp"

namespace dbc {

struct SignalStatement {
  Signal signal;  // its multiplexor is not known yet
  Token place;
};

// What follows SG_.
[[nodiscard]] SignalStatement ReadSignal(TokenReader& in);

// What follows SG_MUL_VAL_, a message id and a signal name: the name of a multiplexor and `first-last,
// first-last;`.
struct MultiplexedValues {
  std::string multiplexor;
  std::vector<RawRange> values;
};
[[nodiscard]] MultiplexedValues ReadMultiplexedValues(TokenReader& in);

// Pairs of value and text up to and with the ';'.
[[nodiscard]] ValueTable ReadValues(TokenReader& in);

// What follows the name of an attribute in BA_DEF_, with the ';'.
[[nodiscard]] AttributeDefinition ReadAttributeType(TokenReader& in);

// The value of an attribute as its definition wants it; as it is written if `definition` is nullptr or does
// not fit.
[[nodiscard]] AttributeValue ReadAttributeValue(TokenReader& in, const AttributeDefinition* definition);

}  // namespace dbc
