#include "dbc/parser.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "dbc/codec.hpp"
#include "dbc/lexer.hpp"

namespace dbc {
namespace {

using Kind = Token::Kind;

constexpr std::uint32_t kExtendedFlag = 0x80000000u;
constexpr std::uint32_t kIndependentSignals = 0xC0000000u;  // id of VECTOR__INDEPENDENT_SIG_MSG
constexpr std::uint32_t kMaxStandardId = 0x7FF;
constexpr std::uint32_t kMaxExtendedId = 0x1FFFFFFF;
constexpr std::uint64_t kMaxMessageLength = 1785;  // [bytes], of the J1939 transport protocol

// Words that begin a statement: where one of them stands, a list of names has ended.
constexpr std::array<std::string_view, 34> kKeywords{"VERSION",
                                                     "NS_",
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
                                                     "FILTER",
                                                     "EV_",
                                                     "EV_DATA_",
                                                     "ENVVAR_DATA_",
                                                     "SGTYPE_",
                                                     "SGTYPE_VAL_",
                                                     "SIG_GROUP_",
                                                     "SIG_VALTYPE_",
                                                     "SIG_TYPE_REF_",
                                                     "SG_MUL_VAL_"};

bool IsKeyword(const Token& token) {
  return token.kind == Kind::kIdentifier && std::ranges::find(kKeywords, token.text) != kKeywords.end();
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& source_name)
      : source_(source_name), tokens_(Tokenize(text, source_name)) {
    database_.source = source_name;
  }

  Database Run() {
    while (Peek().kind != Kind::kEnd) Statement();
    for (PlacedMessage& placed : placed_) ResolveMultiplexing(placed);
    return std::move(database_);
  }

 private:
  // What a message's signals said in the file until the whole of the file is known.
  struct PlacedSignal {
    Token place;
    bool multiplexed = false;
    std::string multiplexor;  // empty: the message's only one
  };
  struct PlacedMessage {
    std::size_t index = 0;  // in Database::messages
    std::vector<PlacedSignal> signals;
  };

  // ---- tokens
  // --------------------------------------------------------------------------------------------------
  [[nodiscard]] const Token& Peek(std::size_t ahead = 0) const {
    return tokens_[std::min(position_ + ahead, tokens_.size() - 1)];
  }
  const Token& Take() {
    const Token& token = Peek();
    if (position_ < tokens_.size() - 1) ++position_;
    return token;
  }

  [[noreturn]] void Fail(const Token& place, const std::string& text) const {
    throw DbcError(source_, place.line, place.column, text);
  }
  [[noreturn]] void FailExpected(const std::string& expected) const {
    Fail(Peek(), "found " + Describe(Peek()) + ", expected " + expected);
  }
  void Warn(const Token& place, const std::string& text) {
    database_.warnings.emplace_back(DbcError(source_, place.line, place.column, text).what());
  }

  [[nodiscard]] bool At(std::string_view punctuation_or_word) const {
    return (Peek().kind == Kind::kPunctuation || Peek().kind == Kind::kIdentifier) &&
           Peek().text == punctuation_or_word;
  }
  bool TakeIf(std::string_view punctuation_or_word) {
    if (!At(punctuation_or_word)) return false;
    Take();
    return true;
  }
  void Expect(const std::string& punctuation, const std::string& after) {
    if (!TakeIf(punctuation)) FailExpected("'" + punctuation + "' after " + after);
  }
  const Token& Identifier(const std::string& what) {
    if (Peek().kind != Kind::kIdentifier || IsKeyword(Peek())) FailExpected(what);
    return Take();
  }
  const Token& String(const std::string& what) {
    if (Peek().kind != Kind::kString) FailExpected(what + " in quotes");
    return Take();
  }

  bool Sign() { return TakeIf("-") || (TakeIf("+"), false); }

  template <typename T>
  [[nodiscard]] static bool Convert(const std::string& text, T& value) {
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    return error == std::errc{} && stopped == end;
  }

  double Real(const std::string& what) {
    const std::size_t start = position_;
    const bool negative = Sign();
    double value = 0.0;
    if (Peek().kind != Kind::kNumber || !Convert(Peek().text, value)) {
      if (Peek().kind != Kind::kNumber) position_ = start;
      FailExpected(what + ", a number");
    }
    Take();
    return negative ? -value : value;
  }

  std::uint64_t Unsigned(const std::string& what, std::uint64_t max) {
    std::uint64_t value = 0;
    if (Peek().kind != Kind::kNumber || !Convert(Peek().text, value) || value > max) {
      FailExpected(what + ", an integer from 0 to " + std::to_string(max));
    }
    Take();
    return value;
  }

  // A raw value: any integer of 64 bits, kept by its bit pattern. Some files write it as 1.0.
  std::int64_t RawValue(const std::string& what) {
    const Token place = Peek();
    const bool negative = Sign();
    std::uint64_t magnitude = 0;
    if (Peek().kind != Kind::kNumber) FailExpected(what + ", an integer");
    if (double real = 0.0; !Convert(Peek().text, magnitude)) {
      if (!Convert(Peek().text, real) || real != std::floor(real) || real >= 0x1p64) {
        FailExpected(what + ", an integer of 64 bits");
      }
      magnitude = static_cast<std::uint64_t>(real);
    }
    Take();
    if (negative && magnitude > (std::uint64_t{1} << 63))
      Fail(place, what + " is below the smallest integer of 64 bits");
    return static_cast<std::int64_t>(negative ? 0 - magnitude : magnitude);
  }

  void SkipStatement() {
    const Token start = Peek();
    while (!At(";")) {
      if (Peek().kind == Kind::kEnd) Fail(start, "found " + Describe(start) + " without a ';' to its end");
      Take();
    }
    Take();
  }

  // ---- statements
  // ----------------------------------------------------------------------------------------------
  void Statement() {
    if (TakeIf(";")) return;
    if (Peek().kind != Kind::kIdentifier) FailExpected("a statement such as BO_, SG_ or CM_");
    const Token keyword = Take();
    using Handler = void (Parser::*)();
    static constexpr std::array<std::pair<std::string_view, Handler>, 14> kHandlers{{
        {"VERSION", &Parser::Version},
        {"NS_", &Parser::NewSymbols},
        {"BS_", &Parser::BitTiming},
        {"BU_", &Parser::Nodes},
        {"BO_", &Parser::MessageStatement},
        {"SG_", &Parser::SignalStatement},
        {"SIG_VALTYPE_", &Parser::SignalValueType},
        {"SG_MUL_VAL_", &Parser::MultiplexedValues},
        {"VAL_TABLE_", &Parser::ValueTableStatement},
        {"VAL_", &Parser::Values},
        {"CM_", &Parser::Comment},
        {"BA_DEF_", &Parser::DefineAttribute},
        {"BA_DEF_DEF_", &Parser::AttributeDefault},
        {"BA_", &Parser::AttributeStatement},
    }};
    for (const auto& [name, handler] : kHandlers) {
      if (name == keyword.text) return (this->*handler)();
    }
    if (!IsKeyword(keyword) && !keyword.text.ends_with('_')) {
      Fail(keyword, "found " + Describe(keyword) + ", expected a statement such as BO_, SG_ or CM_");
    }
    SkipStatement();
  }

  void Version() { database_.version = String("the version").text; }

  // A list of words, most of them keywords: it ends where one of them is used as such.
  void NewSymbols() {
    Expect(":", "NS_");
    while (Peek().kind == Kind::kIdentifier && !At("BS_") && !At("BU_") && !At("BO_") &&
           (Peek(1).kind == Kind::kIdentifier || Peek(1).kind == Kind::kEnd)) {
      Take();
    }
  }

  void BitTiming() {
    Expect(":", "BS_");
    while (Peek().kind == Kind::kNumber || At(":") || At(",") || At(";")) Take();
  }

  void Nodes() {
    Expect(":", "BU_");
    while (Peek().kind == Kind::kIdentifier && !IsKeyword(Peek())) {
      database_.nodes.push_back({.name = Take().text, .attributes = {}, .comment = {}});
      TakeIf(",");
    }
    TakeIf(";");
  }

  void MessageStatement() {
    const Token place = Peek();
    const std::uint64_t raw_id = Unsigned("a message id", std::numeric_limits<std::uint32_t>::max());
    MessageDefinition message;
    message.name = Identifier("a message name").text;
    Expect(":", "the message name");
    message.length = static_cast<unsigned>(Unsigned("the length of the message in bytes", kMaxMessageLength));
    message.transmitter = Identifier("the transmitter of the message").text;

    current_ = nullptr;
    in_independent_signals_ = raw_id == kIndependentSignals || message.name == "VECTOR__INDEPENDENT_SIG_MSG";
    if (in_independent_signals_) return;
    SplitId(place, static_cast<std::uint32_t>(raw_id), message);
    if (const MessageDefinition* other = database_.Find(message.id, message.extended)) {
      Fail(place, "message id " + place.text + " of " + message.name + " is already that of " + other->name);
    }
    if (database_.Find(message.name) != nullptr)
      Warn(place, "message name " + message.name + " is given twice");
    placed_.push_back({.index = database_.messages.size(), .signals = {}});
    database_.messages.push_back(std::move(message));
    current_ = &database_.messages.back();
  }

  void SplitId(const Token& place, std::uint32_t raw_id, MessageDefinition& message) {
    message.extended = (raw_id & kExtendedFlag) != 0;
    message.id = raw_id & ~kExtendedFlag;
    if (message.id > kMaxExtendedId) {
      Fail(place, "message id " + std::to_string(raw_id) + " of " + message.name + " has more than 29 bits");
    }
    if (!message.extended && message.id > kMaxStandardId) {
      Warn(place, "message id " + std::to_string(raw_id) + " of " + message.name +
                      " has more than 11 bits, but not the bit 31 of an extended one");
    }
  }

  void SignalStatement() {
    if (current_ == nullptr && !in_independent_signals_) FailExpected("a BO_ before the first SG_");
    Signal signal;
    PlacedSignal placed;
    placed.place = Peek();
    signal.name = Identifier("a signal name").text;
    if (Peek().kind == Kind::kIdentifier) Multiplexor(signal, placed);
    Expect(":", "the signal name");
    Layout(signal);
    Scaling(signal);
    signal.unit = String("the unit").text;
    while (Peek().kind == Kind::kIdentifier && !IsKeyword(Peek())) {
      signal.receivers.push_back(Take().text);
      TakeIf(",");
    }
    if (in_independent_signals_) return;
    if (current_->Find(signal.name) != nullptr) {
      Fail(placed.place, "signal " + signal.name + " is given twice in message " + current_->name);
    }
    if (!Fits(signal, current_->length)) {
      Fail(placed.place, "signal " + signal.name + " (start bit " + std::to_string(signal.start_bit) + ", " +
                             std::to_string(signal.length) + " bits) is outside message " + current_->name +
                             " of " + std::to_string(current_->length) + " bytes");
    }
    current_->signals.push_back(std::move(signal));
    placed_.back().signals.push_back(std::move(placed));
  }

  // `M`, `m3`, `m3M`, and a lone `m` whose values SG_MUL_VAL_ tells.
  void Multiplexor(Signal& signal, PlacedSignal& placed) {
    std::string_view text = Peek().text;
    if (text.ends_with('M')) {
      signal.is_multiplexor = true;
      text.remove_suffix(1);
    }
    if (text.starts_with('m')) {
      placed.multiplexed = true;
      signal.multiplexing.emplace();
      text.remove_prefix(1);
      if (std::uint64_t value = 0; !text.empty() && Convert(std::string(text), value)) {
        signal.multiplexing->values.push_back({value, value});
        text = {};
      }
    }
    if (!text.empty() || (!signal.is_multiplexor && !placed.multiplexed)) {
      FailExpected("':' or a multiplexor such as M, m0 or m0M after the signal name");
    }
    Take();
  }

  void Layout(Signal& signal) {
    signal.start_bit = static_cast<unsigned>(Unsigned("the start bit", 8 * kMaxMessageLength - 1));
    Expect("|", "the start bit");
    const Token length = Peek();
    signal.length =
        static_cast<unsigned>(Unsigned("the length of the signal in bits", 8 * kMaxMessageLength));
    if (!in_independent_signals_ && (signal.length < 1 || signal.length > 64)) {
      Fail(length, "signal " + signal.name + " has " + length.text + " bits, expected 1 to 64");
    }
    Expect("@", "the length of the signal");
    signal.byte_order = Unsigned("the byte order, 0 = Motorola or 1 = Intel", 1) == 1 ? ByteOrder::kIntel
                                                                                      : ByteOrder::kMotorola;
    if (!At("+") && !At("-")) FailExpected("'+' (unsigned) or '-' (signed) after the byte order");
    signal.type = Take().text == "-" ? ValueType::kSigned : ValueType::kUnsigned;
  }

  void Scaling(Signal& signal) {
    Expect("(", "the sign of the signal");
    const Token factor = Peek();
    signal.factor = Real("the factor");
    if (signal.factor == 0.0) Fail(factor, "signal " + signal.name + " has the factor 0");
    Expect(",", "the factor");
    signal.offset = Real("the offset");
    Expect(")", "the offset");
    Expect("[", "the factor and offset");
    signal.min = Real("the minimum");
    Expect("|", "the minimum");
    signal.max = Real("the maximum");
    Expect("]", "the maximum");
  }

  // ---- statements about messages and signals
  // --------------------------------------------------------------------- The message that an id in the text
  // names; nullptr with a warning if there is none.
  MessageDefinition* MessageReference() {
    const Token place = Peek();
    const std::uint64_t raw_id = Unsigned("a message id", std::numeric_limits<std::uint32_t>::max());
    if (raw_id == kIndependentSignals) return nullptr;
    const bool extended = (raw_id & kExtendedFlag) != 0;
    const MessageDefinition* found =
        database_.Find(static_cast<std::uint32_t>(raw_id & ~kExtendedFlag), extended);
    if (found == nullptr) Warn(place, "there is no message with id " + place.text);
    return const_cast<MessageDefinition*>(found);
  }

  Signal* SignalReference(MessageDefinition** owner = nullptr) {
    MessageDefinition* message = MessageReference();
    if (owner != nullptr) *owner = message;
    const Token name = Identifier("a signal name");
    if (message == nullptr) return nullptr;
    const Signal* found = message->Find(name.text);
    if (found == nullptr) Warn(name, "message " + message->name + " has no signal " + name.text);
    return const_cast<Signal*>(found);
  }

  Node* NodeReference() {
    const Token name = Identifier("a node name");
    const auto found = std::ranges::find(database_.nodes, name.text, &Node::name);
    if (found != database_.nodes.end()) return &*found;
    Warn(name, "there is no node " + name.text);
    return nullptr;
  }

  void SignalValueType() {
    Signal* signal = SignalReference();
    TakeIf(":");
    const Token place = Peek();
    const std::uint64_t type = Unsigned("a value type, 0 = integer, 1 = float, 2 = double", 2);
    Expect(";", "the value type");
    if (signal == nullptr || type == 0) return;
    const unsigned length = type == 1 ? 32 : 64;
    if (signal->length != length) {
      Fail(place, "signal " + signal->name + " is a float of " + std::to_string(signal->length) +
                      " bits, expected " + std::to_string(length));
    }
    signal->type = type == 1 ? ValueType::kFloat32 : ValueType::kFloat64;
  }

  // SG_MUL_VAL_ id signal multiplexor first-last, first-last;
  void MultiplexedValues() {
    MessageDefinition* message = nullptr;
    Signal* signal = SignalReference(&message);
    const std::string multiplexor = Identifier("the name of a multiplexor").text;
    std::vector<RawRange> values;
    do {
      RawRange range;
      range.first = Unsigned("the first value of a range", std::numeric_limits<std::uint64_t>::max());
      Expect("-", "the first value of a range");
      range.last = Unsigned("the last value of a range", std::numeric_limits<std::uint64_t>::max());
      values.push_back(range);
    } while (TakeIf(","));
    Expect(";", "the last range of values");
    if (signal == nullptr) return;
    PlacedMessage& placed = placed_[static_cast<std::size_t>(message - database_.messages.data())];
    PlacedSignal& placed_signal = placed.signals[static_cast<std::size_t>(signal - message->signals.data())];
    placed_signal.multiplexed = true;
    placed_signal.multiplexor = multiplexor;
    signal->multiplexing.emplace().values = std::move(values);
  }

  ValueTable ValuesUntilSemicolon() {
    ValueTable values;
    while (!TakeIf(";")) {
      const std::int64_t value = RawValue("a value of the table, or ';'");
      values.insert_or_assign(value, String("the text of the value").text);
    }
    return values;
  }

  void ValueTableStatement() {
    const std::string name = Identifier("the name of a value table").text;
    database_.value_tables.insert_or_assign(name, ValuesUntilSemicolon());
  }

  void Values() {
    if (Peek().kind == Kind::kIdentifier) return SkipStatement();  // of an environment variable
    Signal* signal = SignalReference();
    ValueTable values;
    if (Peek().kind == Kind::kIdentifier) {
      const auto table = database_.value_tables.find(Peek().text);
      if (table == database_.value_tables.end()) FailExpected("the name of a value table, or values");
      Take();
      Expect(";", "the name of the value table");
      values = table->second;
    } else {
      values = ValuesUntilSemicolon();
    }
    if (signal != nullptr) signal->values = std::move(values);
  }

  void Comment() {
    std::string unused;
    std::string* comment = &database_.comment;
    if (TakeIf("BU_")) {
      Node* node = NodeReference();
      comment = node != nullptr ? &node->comment : &unused;
    } else if (TakeIf("BO_")) {
      MessageDefinition* message = MessageReference();
      comment = message != nullptr ? &message->comment : &unused;
    } else if (TakeIf("SG_")) {
      Signal* signal = SignalReference();
      comment = signal != nullptr ? &signal->comment : &unused;
    } else if (TakeIf("EV_")) {
      Identifier("the name of an environment variable");
      comment = &unused;
    }
    *comment = String("a comment").text;
    Expect(";", "the comment");
  }

  // ---- attributes
  // ------------------------------------------------------------------------------------------------
  void DefineAttribute() {
    AttributeDefinition definition;
    if (Peek().kind == Kind::kIdentifier) definition.object = Take().text;
    const std::string name = String("the name of an attribute").text;
    if (TakeIf("ENUM")) {
      definition.type = AttributeType::kEnumeration;
      do {
        if (Peek().kind != Kind::kString) break;
        definition.choices.push_back(Take().text);
      } while (TakeIf(","));
    } else if (!TakeIf("STRING")) {
      if (TakeIf("INT")) {
        definition.type = AttributeType::kInteger;
      } else if (TakeIf("HEX")) {
        definition.type = AttributeType::kHex;
      } else if (TakeIf("FLOAT")) {
        definition.type = AttributeType::kFloat;
      } else {
        FailExpected("the type of the attribute: INT, HEX, FLOAT, STRING or ENUM");
      }
      if (!At(";")) {
        definition.min = Real("the minimum");
        definition.max = Real("the maximum");
      }
    }
    Expect(";", "the definition of the attribute");
    database_.attribute_definitions.insert_or_assign(name, std::move(definition));
  }

  // The value as its definition wants it; without a definition as it is written.
  AttributeValue Value(const AttributeDefinition* definition) {
    if (Peek().kind == Kind::kString) return Take().text;
    const Token place = Peek();
    const bool negative = Sign();
    std::int64_t integer = 0;
    const bool is_integer = Peek().kind == Kind::kNumber && Convert(Peek().text, integer);
    double real = 0.0;
    if (Peek().kind != Kind::kNumber || !Convert(Peek().text, real)) {
      FailExpected("the value of the attribute, a number or a text in quotes");
    }
    Take();
    if (definition != nullptr && definition->type == AttributeType::kEnumeration && is_integer && !negative) {
      if (static_cast<std::uint64_t>(integer) >= definition->choices.size()) {
        Fail(place, "the value " + place.text + " of the attribute is not among its " +
                        std::to_string(definition->choices.size()) + " choices");
      }
      return definition->choices[static_cast<std::size_t>(integer)];
    }
    if (is_integer && (definition == nullptr || definition->type != AttributeType::kFloat)) {
      return negative ? -integer : integer;
    }
    return negative ? -real : real;
  }

  void AttributeDefault() {
    const Token name = String("the name of an attribute");
    const auto definition = database_.attribute_definitions.find(name.text);
    const bool known = definition != database_.attribute_definitions.end();
    AttributeValue value = Value(known ? &definition->second : nullptr);
    Expect(";", "the default of the attribute");
    if (known) {
      definition->second.default_value = std::move(value);
    } else {
      Warn(name, "there is no definition of attribute " + Describe(name));
    }
  }

  void AttributeStatement() {
    const Token name = String("the name of an attribute");
    Attributes unused;
    Attributes* attributes = &database_.attributes;
    if (TakeIf("BU_")) {
      Node* node = NodeReference();
      attributes = node != nullptr ? &node->attributes : &unused;
    } else if (TakeIf("BO_")) {
      MessageDefinition* message = MessageReference();
      attributes = message != nullptr ? &message->attributes : &unused;
    } else if (TakeIf("SG_")) {
      Signal* signal = SignalReference();
      attributes = signal != nullptr ? &signal->attributes : &unused;
    } else if (TakeIf("EV_")) {
      Identifier("the name of an environment variable");
      attributes = &unused;
    }
    const auto definition = database_.attribute_definitions.find(name.text);
    const bool known = definition != database_.attribute_definitions.end();
    attributes->insert_or_assign(name.text, Value(known ? &definition->second : nullptr));
    Expect(";", "the value of the attribute");
  }

  // ---- once the whole file is known
  // --------------------------------------------------------------------------------
  void ResolveMultiplexing(PlacedMessage& placed) {
    MessageDefinition& message = database_.messages[placed.index];
    for (std::size_t i = 0; i < message.signals.size(); ++i) {
      if (!placed.signals[i].multiplexed) continue;
      message.signals[i].multiplexing->multiplexor = FindMultiplexor(message, placed.signals[i]);
    }
    for (std::size_t i = 0; i < message.signals.size(); ++i) {
      std::size_t steps = 0;
      for (const Signal* s = &message.signals[i]; s->multiplexing;
           s = &message.signals[s->multiplexing->multiplexor]) {
        if (++steps > message.signals.size()) {
          Fail(placed.signals[i].place,
               "the multiplexors of signal " + message.signals[i].name + " go in circles");
        }
      }
    }
  }

  [[nodiscard]] std::size_t FindMultiplexor(const MessageDefinition& message,
                                            const PlacedSignal& placed) const {
    std::size_t found = message.signals.size();
    std::size_t count = 0;
    for (std::size_t i = 0; i < message.signals.size(); ++i) {
      const Signal& candidate = message.signals[i];
      if (placed.multiplexor.empty() ? candidate.is_multiplexor && !candidate.multiplexing
                                     : candidate.name == placed.multiplexor) {
        found = i;
        ++count;
      }
    }
    if (count == 1) return found;
    const std::string name = Describe(placed.place);
    if (!placed.multiplexor.empty()) {
      Fail(placed.place, "the multiplexor " + placed.multiplexor + " of signal " + name +
                             " is not in message " + message.name);
    }
    Fail(placed.place, "signal " + name + " is multiplexed, but message " + message.name + " has " +
                           std::to_string(count) + " multiplexors, expected one");
  }

  std::string source_;
  std::vector<Token> tokens_;
  std::size_t position_ = 0;
  Database database_;
  std::vector<PlacedMessage> placed_;     // one for each of Database::messages
  MessageDefinition* current_ = nullptr;  // to which the next SG_ belongs
  bool in_independent_signals_ = false;
};

}  // namespace

DbcError::DbcError(const std::string& source_name, int line, int column, const std::string& text)
    : std::runtime_error(source_name + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " +
                         text) {}

Database Parse(std::string_view text, const std::string& source_name) {
  return Parser(text, source_name).Run();
}

}  // namespace dbc
