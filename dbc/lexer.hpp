// Text of a DBC file to tokens, each with its place.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dbc {

struct Token {
  enum class Kind : std::uint8_t {
    kIdentifier,   // letters, digits, '_'; no digit first
    kNumber,       // without its sign
    kString,       // `text` is what stands between the quotes, `\"` already `"`
    kPunctuation,  // any other character
    kEnd,
  };
  Kind kind = Kind::kEnd;
  std::string text;
  int line = 1;  // from 1
  int column = 1;
};

// The token as an error message shows it.
[[nodiscard]] std::string Describe(const Token& token);

// Throws DbcError: a string without an end, or a character that no DBC statement begins with. The last token
// is kEnd.
[[nodiscard]] std::vector<Token> Tokenize(std::string_view text, const std::string& source_name);

}  // namespace dbc
