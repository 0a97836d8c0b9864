// Reads a DBC file.
//
// Understood and kept: VERSION, BU_, BO_, SG_ (both byte orders, signed, up to 64 bits), SIG_VALTYPE_
// (floats), simple multiplexing (`M`, `m0`) and extended multiplexing (`m0M`, SG_MUL_VAL_), VAL_, VAL_TABLE_,
// CM_, BA_DEF_, BA_DEF_DEF_, BA_. NS_ and BS_ are read and dropped; every other statement is skipped up to its
// `;`. The signals of VECTOR__INDEPENDENT_SIG_MSG belong to no message and are dropped.
//
// Harmless errors of real files become warnings in the Database: a statement about a message, signal, node or
// attribute that does not exist; a message name given twice; a standard id above 0x7FF.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "dbc/database.hpp"

namespace dbc {

// what() is one line, "FILE:LINE:COLUMN: ...", with what was found and what was expected.
class DbcError : public std::runtime_error {
 public:
  DbcError(const std::string& source_name, int line, int column, const std::string& text);
};

// Throws DbcError for a syntax error; a message id that has more than 29 bits or is given twice; a signal name
// given twice in a message; a signal that is outside its message, has 0 or more than 64 bits or a factor of 0, or
// is a float of the wrong length; multiplexors that are missing, ambiguous or circular.
[[nodiscard]] Database Parse(std::string_view text, const std::string& source_name);

}  // namespace dbc
