#include "dbc/parser.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "dbc/codec.hpp"
#include "dbc/multiplexing.hpp"
#include "dbc/statement_readers.hpp"
#include "dbc/token_reader.hpp"

namespace dbc {
namespace {

constexpr std::uint32_t kExtendedFlag = 0x80000000u;
constexpr std::uint32_t kIndependentSignals = 0xC0000000u;  // id of VECTOR__INDEPENDENT_SIG_MSG
constexpr std::uint32_t kMaxStandardId = 0x7FF;
constexpr std::uint32_t kMaxExtendedId = 0x1FFFFFFF;
constexpr std::uint64_t kMaxRawId = std::numeric_limits<std::uint32_t>::max();

// Reads the file token by token. Names and ids are looked up among those read before, as the format requires.
class Parser {
 public:
  Parser(std::string_view text, const std::string& source_name) : in_(text, source_name) {
    database_.source = source_name;
  }

  Database Run() {
    while (!in_.AtEnd()) Statement();
    for (std::size_t i = 0; i < database_.messages.size(); ++i)
      ResolveMultiplexing(in_, notes_[i], database_.messages[i]);
    return std::move(database_);
  }

 private:
  // The object to which a comment or an attribute belongs.
  struct Target {
    std::string* comment;
    Attributes* attributes;
  };

  void Warn(const Token& place, const std::string& text) {
    database_.warnings.push_back(in_.Place(place, text));
  }

  void Statement() {
    using Handler = void (Parser::*)();
    static constexpr std::array<std::pair<std::string_view, Handler>, 14> kHandlers{{
        {"VERSION", &Parser::Version},
        {"NS_", &Parser::NewSymbols},
        {"BS_", &Parser::BitTiming},
        {"BU_", &Parser::Nodes},
        {"BO_", &Parser::MessageStatement},
        {"SG_", &Parser::SignalOfMessage},
        {"SIG_VALTYPE_", &Parser::SignalValueType},
        {"SG_MUL_VAL_", &Parser::ValuesOfMultiplexor},
        {"VAL_TABLE_", &Parser::NamedValueTable},
        {"VAL_", &Parser::ValuesOfSignal},
        {"CM_", &Parser::Comment},
        {"BA_DEF_", &Parser::AttributeType},
        {"BA_DEF_DEF_", &Parser::AttributeDefault},
        {"BA_", &Parser::Attribute},
    }};
    if (in_.TakeIf(";")) return;
    const auto handler =
        std::ranges::find(kHandlers, in_.Peek().text, &std::pair<std::string_view, Handler>::first);
    if (in_.AtIdentifier() && handler != kHandlers.end()) {
      in_.Take();
      (this->*handler->second)();
    } else if (in_.AtIdentifier() && in_.Peek().text.ends_with('_')) {
      in_.SkipStatement();
    } else {
      in_.FailExpected("a statement such as BO_, SG_ or CM_");
    }
  }

  void Version() { database_.version = in_.String("the version").text; }

  void NewSymbols() { SkipNewSymbols(in_); }
  void BitTiming() { SkipBitTiming(in_); }

  void Nodes() {
    in_.Expect(":", "BU_");
    while (in_.AtName()) {
      database_.nodes.push_back({.name = in_.Take().text, .attributes = {}, .comment = {}});
      in_.TakeIf(",");
    }
  }

  // ---- messages and signals ----
  void MessageStatement() {
    const Token place = in_.Peek();
    const auto raw_id = static_cast<std::uint32_t>(in_.Unsigned("a message id", kMaxRawId));
    MessageDefinition message;
    message.id = raw_id & ~kExtendedFlag;
    message.extended = (raw_id & kExtendedFlag) != 0;
    message.name = in_.Name("a message name").text;
    in_.Expect(":", "the message name");
    message.length =
        static_cast<unsigned>(in_.Unsigned("the length of the message in bytes", kMaxMessageLength));
    message.transmitter = in_.Name("the transmitter of the message").text;

    in_independent_signals_ = raw_id == kIndependentSignals;
    in_message_ = !in_independent_signals_;
    if (in_independent_signals_) return;
    CheckMessage(place, message);
    database_.messages.push_back(std::move(message));
    notes_.emplace_back();
  }

  void CheckMessage(const Token& place, const MessageDefinition& message) {
    const std::string subject = "message id " + place.text + " of " + message.name;
    if (message.id > kMaxExtendedId) in_.Fail(place, subject + " has more than 29 bits");
    if (const MessageDefinition* other = database_.Find(message.id, message.extended)) {
      in_.Fail(place, subject + " is already that of " + other->name);
    }
    if (!message.extended && message.id > kMaxStandardId) {
      Warn(place, subject + " has more than 11 bits, but not the bit 31 of an extended one");
    }
    if (database_.Find(message.name) != nullptr)
      Warn(place, "message name " + message.name + " is given twice");
  }

  void SignalOfMessage() {
    if (!in_message_ && !in_independent_signals_)
      in_.FailExpected("BO_, the message of the signal, before SG_");
    auto [signal, place] = ReadSignal(in_);
    if (in_independent_signals_) return;
    MessageDefinition& message = database_.messages.back();
    if (message.Find(signal.name) != nullptr) {
      in_.Fail(place, "signal " + signal.name + " is given twice in message " + message.name);
    }
    if (!Fits(signal, message.length)) {
      in_.Fail(place, "signal " + signal.name + " (start bit " + std::to_string(signal.start_bit) + ", " +
                          std::to_string(signal.length) + " bits) is outside message " + message.name +
                          " of " + std::to_string(message.length) + " bytes");
    }
    message.signals.push_back(std::move(signal));
    notes_.back().push_back({.place = place, .multiplexor = {}});
  }

  // These return nullptr for what does not exist: with a warning, unless it belongs to VECTOR__INDEPENDENT_SIG_MSG.
  MessageDefinition* MessageReference() {
    const Token place = in_.Peek();
    const auto raw_id = static_cast<std::uint32_t>(in_.Unsigned("a message id", kMaxRawId));
    if (raw_id == kIndependentSignals) return nullptr;
    const auto found = std::ranges::find_if(database_.messages, [raw_id](const MessageDefinition& message) {
      return (message.extended ? message.id | kExtendedFlag : message.id) == raw_id;
    });
    if (found != database_.messages.end()) return &*found;
    Warn(place, "there is no message with id " + place.text);
    return nullptr;
  }

  Signal* SignalReference() { return SignalIn(MessageReference()); }

  Signal* SignalIn(MessageDefinition* message) {
    const Token name = in_.Name("a signal name");
    if (message == nullptr) return nullptr;
    const auto found = std::ranges::find(message->signals, name.text, &Signal::name);
    if (found != message->signals.end()) return &*found;
    Warn(name, "message " + message->name + " has no signal " + name.text);
    return nullptr;
  }

  Node* NodeReference() {
    const Token name = in_.Name("a node name");
    const auto found = std::ranges::find(database_.nodes, name.text, &Node::name);
    if (found != database_.nodes.end()) return &*found;
    Warn(name, "there is no node " + name.text);
    return nullptr;
  }

  void SignalValueType() {
    Signal* signal = SignalReference();
    in_.TakeIf(":");
    const Token place = in_.Peek();
    const std::uint64_t type = in_.Unsigned("a value type: 0 = integer, 1 = float, 2 = double", 2);
    in_.Expect(";", "the value type");
    if (signal == nullptr || type == 0) return;
    const unsigned length = type == 1 ? 32 : 64;
    if (signal->length != length) {
      in_.Fail(place, "signal " + signal->name + " is a float of " + std::to_string(signal->length) +
                          " bits, expected " + std::to_string(length));
    }
    signal->type = type == 1 ? ValueType::kFloat32 : ValueType::kFloat64;
  }

  void ValuesOfMultiplexor() {
    MessageDefinition* message = MessageReference();
    Signal* signal = SignalIn(message);
    MultiplexedValues statement = ReadMultiplexedValues(in_);
    if (signal == nullptr) return;
    const auto message_index = static_cast<std::size_t>(message - database_.messages.data());
    const auto signal_index = static_cast<std::size_t>(signal - message->signals.data());
    notes_[message_index][signal_index].multiplexor = std::move(statement.multiplexor);
    signal->multiplexing.emplace().values = std::move(statement.values);
  }

  void NamedValueTable() {
    const std::string name = in_.Name("the name of a value table").text;
    database_.value_tables.insert_or_assign(name, ReadValues(in_));
  }

  void ValuesOfSignal() {
    if (in_.AtIdentifier()) return in_.SkipStatement();  // values of an environment variable
    Signal* signal = SignalReference();
    ValueTable values;
    if (const auto table = database_.value_tables.find(in_.Peek().text);
        in_.AtIdentifier() && table != database_.value_tables.end()) {
      in_.Take();
      in_.Expect(";", "the name of the value table");
      values = table->second;
    } else {
      values = ReadValues(in_);
    }
    if (signal != nullptr) signal->values = std::move(values);
  }

  // ---- comments and attributes ----
  // Takes `BU_ node`, `BO_ id`, `SG_ id signal`, `EV_ variable`, or nothing, which means the network.
  Target TakeTarget() {
    const Target lost{&lost_comment_, &lost_attributes_};
    const auto of = [&](auto* object) {
      return object != nullptr ? Target{&object->comment, &object->attributes} : lost;
    };
    if (in_.TakeIf("BU_")) return of(NodeReference());
    if (in_.TakeIf("BO_")) return of(MessageReference());
    if (in_.TakeIf("SG_")) return of(SignalReference());
    if (!in_.TakeIf("EV_")) return of(&database_);
    in_.Name("the name of an environment variable");
    return lost;
  }

  void Comment() {
    const Target target = TakeTarget();
    *target.comment = in_.String("a comment").text;
    in_.Expect(";", "the comment");
  }

  void AttributeType() {
    std::string object;
    if (in_.AtIdentifier()) object = in_.Take().text;
    const std::string name = in_.String("the name of an attribute").text;
    AttributeDefinition definition = ReadAttributeType(in_);
    definition.object = std::move(object);
    database_.attribute_definitions.insert_or_assign(name, std::move(definition));
  }

  // Returns nullptr, with a warning, if there is none.
  AttributeDefinition* DefinitionOf(const Token& name) {
    const auto found = database_.attribute_definitions.find(name.text);
    if (found != database_.attribute_definitions.end()) return &found->second;
    Warn(name, "there is no definition of attribute " + Describe(name));
    return nullptr;
  }

  void AttributeDefault() {
    AttributeDefinition* definition = DefinitionOf(in_.String("the name of an attribute"));
    AttributeValue value = ReadAttributeValue(in_, definition);
    in_.Expect(";", "the default of the attribute");
    if (definition != nullptr) definition->default_value = std::move(value);
  }

  void Attribute() {
    const Token name = in_.String("the name of an attribute");
    const Target target = TakeTarget();
    target.attributes->insert_or_assign(name.text, ReadAttributeValue(in_, DefinitionOf(name)));
    in_.Expect(";", "the value of the attribute");
  }

  TokenReader in_;
  Database database_;
  std::vector<std::vector<SignalNote>> notes_;  // notes on the signals of Database::messages
  bool in_message_ = false;                     // SG_ belongs to the last message
  bool in_independent_signals_ = false;         // SG_ belongs to no message
  std::string lost_comment_;                    // takes comments on what does not exist
  Attributes lost_attributes_;
};

}  // namespace

DbcError::DbcError(const std::string& source_name, int line, int column, const std::string& text)
    : std::runtime_error(source_name + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " +
                         text) {}

Database Parse(std::string_view text, const std::string& source_name) {
  return Parser(text, source_name).Run();
}

}  // namespace dbc
