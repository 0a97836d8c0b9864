// Splits the text of a DBC file into tokens, each with its place.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dbc {

struct Token {
  enum class Kind : std::uint8_t {
    kIdentifier,   // letters, digits, '_'; does not begin with a digit
    kNumber,       // without its sign
    kString,       // `text` is the part between the quotes, with `"` for `\"`
    kPunctuation,  // any other character
    kEnd,
  };
  Kind kind = Kind::kEnd;
  std::string text;
  int line = 1;  // counted from 1
  int column = 1;
};

// The token as an error message shows it.
[[nodiscard]] std::string Describe(const Token& token);

// The last token is kEnd. Throws DbcError if a string has no closing quote.
[[nodiscard]] std::vector<Token> Tokenize(std::string_view text, const std::string& source_name);

}  // namespace dbc
