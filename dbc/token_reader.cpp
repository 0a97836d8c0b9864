#include "dbc/token_reader.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "dbc/parser.hpp"

namespace dbc {
namespace {

using Kind = Token::Kind;

constexpr std::array<std::string_view, 33> kKeywords{"NS_",
                                                     "NS_DESC_",
                                                     "BS_",
                                                     "BU_",
                                                     "BO_",
                                                     "SG_",
                                                     "BO_TX_BU_",
                                                     "CM_",
                                                     "BA_",
                                                     "BA_DEF_",
                                                     "BA_DEF_DEF_",
                                                     "BA_DEF_REL_",
                                                     "BA_REL_",
                                                     "BA_DEF_DEF_REL_",
                                                     "BA_DEF_SGTYPE_",
                                                     "BA_SGTYPE_",
                                                     "BU_SG_REL_",
                                                     "BU_EV_REL_",
                                                     "BU_BO_REL_",
                                                     "VAL_",
                                                     "VAL_TABLE_",
                                                     "CAT_DEF_",
                                                     "CAT_",
                                                     "EV_",
                                                     "EV_DATA_",
                                                     "ENVVAR_DATA_",
                                                     "SGTYPE_",
                                                     "SGTYPE_VAL_",
                                                     "SIG_GROUP_",
                                                     "SIG_VALTYPE_",
                                                     "SIG_TYPE_REF_",
                                                     "SIGTYPE_VALTYPE_",
                                                     "SG_MUL_VAL_"};

template <typename T>
bool Convert(const std::string& text, T& value) {
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stopped == end;
}

}  // namespace

bool IsKeyword(const Token& token) {
  return token.kind == Kind::kIdentifier && std::ranges::find(kKeywords, token.text) != kKeywords.end();
}

TokenReader::TokenReader(std::string_view text, const std::string& source_name)
    : source_(source_name), tokens_(Tokenize(text, source_name)) {}

const Token& TokenReader::Peek(std::size_t ahead) const {
  return tokens_[std::min(position_ + ahead, tokens_.size() - 1)];
}

const Token& TokenReader::Take() {
  const Token& token = Peek();
  if (position_ + 1 < tokens_.size()) ++position_;
  return token;
}

bool TokenReader::At(std::string_view punctuation_or_word) const {
  return (Peek().kind == Kind::kPunctuation || AtIdentifier()) && Peek().text == punctuation_or_word;
}

bool TokenReader::TakeIf(std::string_view punctuation_or_word) {
  if (!At(punctuation_or_word)) return false;
  Take();
  return true;
}

void TokenReader::Expect(const std::string& punctuation, const std::string& after) {
  if (!TakeIf(punctuation)) FailExpected("'" + punctuation + "' after " + after);
}

const Token& TokenReader::Name(const std::string& what) {
  if (!AtName()) FailExpected(what);
  return Take();
}

const Token& TokenReader::String(const std::string& what) {
  if (Peek().kind != Kind::kString) FailExpected(what + " in quotes");
  return Take();
}

bool TokenReader::TakeSign() {
  if (TakeIf("-")) return true;
  TakeIf("+");
  return false;
}

double TokenReader::Real(const std::string& what) {
  const bool negative = TakeSign();
  double value = 0.0;
  if (Peek().kind != Kind::kNumber || !Convert(Peek().text, value)) FailExpected(what + ", a number");
  Take();
  return negative ? -value : value;
}

std::uint64_t TokenReader::Unsigned(const std::string& what, std::uint64_t max) {
  std::uint64_t value = 0;
  if (Peek().kind != Kind::kNumber || !Convert(Peek().text, value) || value > max) {
    FailExpected(what + ", an integer from 0 to " + std::to_string(max));
  }
  Take();
  return value;
}

bool TokenReader::AtInteger() const {
  const std::size_t sign = At("-") || At("+") ? 1 : 0;
  std::uint64_t value = 0;
  return Peek(sign).kind == Kind::kNumber && Convert(Peek(sign).text, value);
}

std::int64_t TokenReader::Integer(const std::string& what) {
  const bool negative = TakeSign();
  std::uint64_t magnitude = 0;
  double real = 0.0;
  const bool is_number = Peek().kind == Kind::kNumber;
  if (!is_number || !Convert(Peek().text, magnitude)) {
    const bool is_whole =
        is_number && Convert(Peek().text, real) && real == std::floor(real) && real < 0x1p64;
    if (!is_whole) FailExpected(what + ", an integer of 64 bits");
    magnitude = static_cast<std::uint64_t>(real);
  }
  if (negative && magnitude > std::uint64_t{1} << 63) FailExpected(what + ", an integer of 64 bits");
  Take();
  return static_cast<std::int64_t>(negative ? 0 - magnitude : magnitude);
}

void TokenReader::SkipStatement() {
  const Token& start = Peek();
  while (!TakeIf(";")) {
    if (AtEnd()) Fail(start, "found " + Describe(start) + " without a ';' up to the end of the file");
    Take();
  }
}

std::string TokenReader::Place(const Token& token, const std::string& text) const {
  return DbcError(source_, token.line, token.column, text).what();
}

void TokenReader::Fail(const Token& place, const std::string& text) const {
  throw DbcError(source_, place.line, place.column, text);
}

void TokenReader::FailExpected(const std::string& expected) const {
  Fail(Peek(), "found " + Describe(Peek()) + ", expected " + expected);
}

}  // namespace dbc
