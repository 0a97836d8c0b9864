// Which multiplexor selects a signal: it may stand after the signal in the file, or in a statement of its own.
#pragma once

#include <string>
#include <vector>

#include "dbc/database.hpp"
#include "dbc/lexer.hpp"
#include "dbc/token_reader.hpp"

namespace dbc {

// Data about a signal that are needed until the whole file is read.
struct SignalNote {
  Token place;
  std::string multiplexor;  // empty: the only one of the message
};

// Sets the multiplexor of each multiplexed signal; `notes` are those of the message's signals. Throws DbcError at a signal
// whose multiplexor is missing, ambiguous or, through others, the signal itself.
void ResolveMultiplexing(const TokenReader& in, const std::vector<SignalNote>& notes,
                         MessageDefinition& message);

}  // namespace dbc
