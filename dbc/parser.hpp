// Reads a DBC file.
//
// Understood and kept: VERSION, BU_, BO_, SG_ (both byte orders, signed, up to 64 bits), SIG_VALTYPE_
// (floats), simple multiplexing (`M`, `m0`) and extended multiplexing (`m0M`, SG_MUL_VAL_), VAL_, VAL_TABLE_,
// CM_, BA_DEF_, BA_DEF_DEF_, BA_. Every other statement is skipped up to its `;`. The signals of
// VECTOR__INDEPENDENT_SIG_MSG belong to no message and are dropped.
//
// Where real files go wrong without harm there is a warning in the Database: a comment, attribute or value
// table of a message or signal that does not exist; a message name given twice; a standard id above 0x7FF.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "dbc/database.hpp"

namespace dbc {

// what() is one line, "FILE:LINE:COLUMN: ...", and says what was found and what was expected.
class DbcError : public std::runtime_error {
 public:
  DbcError(const std::string& source_name, int line, int column, const std::string& text);
};

// Throws DbcError: a syntax error; a message id or signal name given twice; a signal that is outside its
// message, has 0 or more than 64 bits or a factor of 0, or is a float of a wrong length; a multiplexor
// missing or going in circles.
[[nodiscard]] Database Parse(std::string_view text, const std::string& source_name);

}  // namespace dbc
