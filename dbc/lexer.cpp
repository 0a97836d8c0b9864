#include "dbc/lexer.hpp"

#include <cstdio>

#include "dbc/parser.hpp"

namespace dbc {
namespace {

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}
bool IsLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool IsSpace(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}

class Lexer {
 public:
  Lexer(std::string_view text, const std::string& source_name) : text_(text), source_name_(source_name) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);  // UTF-8 byte order mark
  }

  Token Next() {
    while (!AtEnd() && IsSpace(Peek())) Take();
    Token token;
    token.line = line_;
    token.column = column_;
    if (AtEnd()) return token;
    const char c = Peek();
    if (IsLetter(c)) {
      token.kind = Token::Kind::kIdentifier;
      while (!AtEnd() && (IsLetter(Peek()) || IsDigit(Peek()))) token.text += Take();
    } else if (IsDigit(c) || (c == '.' && IsDigit(Peek(1)))) {
      token.kind = Token::Kind::kNumber;
      TakeNumber(token);
    } else if (c == '"') {
      token.kind = Token::Kind::kString;
      TakeString(token);
    } else {
      token.kind = Token::Kind::kPunctuation;
      token.text = Take();
    }
    return token;
  }

 private:
  [[nodiscard]] bool AtEnd() const { return position_ >= text_.size(); }
  [[nodiscard]] char Peek(std::size_t ahead = 0) const {
    return position_ + ahead < text_.size() ? text_[position_ + ahead] : '\0';
  }

  char Take() {
    const char c = text_[position_++];
    ++column_;
    if (c == '\n') {
      ++line_;
      column_ = 1;
    }
    return c;
  }

  void TakeNumber(Token& token) {
    const auto digits = [&] {
      while (IsDigit(Peek())) token.text += Take();
    };
    digits();
    if (Peek() == '.') token.text += Take();
    digits();
    if (Peek() != 'e' && Peek() != 'E') return;
    const std::size_t sign = Peek(1) == '+' || Peek(1) == '-' ? 1 : 0;
    if (!IsDigit(Peek(1 + sign))) return;
    for (std::size_t i = 0; i <= sign; ++i) token.text += Take();
    digits();
  }

  void TakeString(Token& token) {
    Take();
    while (!AtEnd() && Peek() != '"') {
      if (Peek() == '\\' && Peek(1) == '"') Take();
      token.text += Take();
    }
    if (AtEnd())
      throw DbcError(source_name_, token.line, token.column, "found a string without its closing '\"'");
    Take();
  }

  std::string_view text_;
  const std::string& source_name_;
  std::size_t position_ = 0;
  int line_ = 1;
  int column_ = 1;
};

}  // namespace

std::string Describe(const Token& token) {
  if (token.kind == Token::Kind::kEnd) return "the end of the file";
  // An error is one line: a long text is cut, and everything but printable ASCII is escaped.
  constexpr std::size_t kShown = 32;
  std::string text;
  for (const char c : token.text.substr(0, kShown)) {
    if (c >= ' ' && c < 0x7F) {
      text += c;
    } else {
      char escaped[5];
      std::snprintf(escaped, sizeof escaped, "\\x%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
      text += escaped;
    }
  }
  if (token.text.size() > kShown) text += "...";
  const char quote = token.kind == Token::Kind::kString ? '"' : '\'';
  return quote + text + quote;
}

std::vector<Token> Tokenize(std::string_view text, const std::string& source_name) {
  Lexer lexer(text, source_name);
  std::vector<Token> tokens;
  do {
    tokens.push_back(lexer.Next());
  } while (tokens.back().kind != Token::Kind::kEnd);
  return tokens;
}

}  // namespace dbc
