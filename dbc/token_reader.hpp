// Goes through the tokens of a DBC file; a token that does not fit throws a DbcError with what was expected.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dbc/lexer.hpp"

namespace dbc {

// True for the keywords of the DBC format; a keyword ends a list of names.
[[nodiscard]] bool IsKeyword(const Token& token);

class TokenReader {
 public:
  TokenReader(std::string_view text, const std::string& source_name);

  [[nodiscard]] const Token& Peek(std::size_t ahead = 0) const;
  const Token& Take();
  [[nodiscard]] bool AtEnd() const { return Peek().kind == Token::Kind::kEnd; }
  [[nodiscard]] bool AtIdentifier() const { return Peek().kind == Token::Kind::kIdentifier; }
  [[nodiscard]] bool AtName() const { return AtIdentifier() && !IsKeyword(Peek()); }
  [[nodiscard]] bool At(std::string_view punctuation_or_word) const;
  bool TakeIf(std::string_view punctuation_or_word);

  // `what` and `after` complete the sentence "found ..., expected ...".
  void Expect(const std::string& punctuation, const std::string& after);
  const Token& Name(const std::string& what);
  const Token& String(const std::string& what);
  [[nodiscard]] double Real(const std::string& what);
  [[nodiscard]] std::uint64_t Unsigned(const std::string& what, std::uint64_t max);
  // Takes any 64-bit integer; one above the largest int64 becomes its bit pattern. Some files write 1 as 1.0.
  [[nodiscard]] std::int64_t Integer(const std::string& what);
  [[nodiscard]] bool AtInteger() const;  // an optional sign and digits only
  void SkipStatement();

  [[nodiscard]] std::string Place(const Token& token, const std::string& text) const;
  [[noreturn]] void Fail(const Token& place, const std::string& text) const;
  [[noreturn]] void FailExpected(const std::string& expected) const;

 private:
  bool TakeSign();

  std::string source_;
  std::vector<Token> tokens_;
  std::size_t position_ = 0;
};

}  // namespace dbc
