#include "bus/vehicle_bus.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "bus/message_fields.hpp"
#include "dbc/e2e.hpp"
#include "dbc/parser.hpp"

namespace bus {
namespace {

constexpr std::size_t kTypes = std::variant_size_v<Message>;

// A message of the DBC with the signals and attributes that all our messages have.
struct BoundMessage {
  std::uint32_t id = 0;
  std::size_t length = 0;
  std::uint16_t data_id = 0;
  const dbc::Signal* crc = nullptr;
  const dbc::Signal* counter = nullptr;
  std::vector<std::size_t> types;  // the typed messages that it carries, as indices of the variant
};

// A typed message, with its signals in the order of kFields.
struct BoundType {
  std::size_t message = 0;                   // index in Binding::messages
  const dbc::Signal* multiplexor = nullptr;  // nullptr: not multiplexed
  std::uint64_t multiplexor_value = 0;
  std::vector<const dbc::Signal*> signals;
};

// Calls visit(member, signal) for each field until one returns false.
template <typename Struct, typename Visit>
bool ForEachField(Struct& message, const BoundType& type, Visit&& visit) {
  return std::apply(
      [&](const auto&... field) {
        std::size_t i = 0;
        return (visit(message.*field.member, *type.signals[i++]) && ...);
      },
      kFields<std::remove_const_t<Struct>>.fields);
}

template <std::size_t kIndex>
std::optional<Message> DecodeType(const BoundType& type, std::span<const std::byte> payload) {
  std::variant_alternative_t<kIndex, Message> message;
  const auto read = [&](auto& member, const dbc::Signal& signal) {
    return FromPhysical(dbc::DecodeSignal(signal, payload), member);
  };
  if (!ForEachField(message, type, read)) return std::nullopt;
  return message;
}

using DecodeFunction = std::optional<Message> (*)(const BoundType&, std::span<const std::byte>);

template <std::size_t... kIndices>
constexpr std::array<DecodeFunction, kTypes> MakeDecoders(std::index_sequence<kIndices...>) {
  return {&DecodeType<kIndices>...};
}

constexpr std::array<DecodeFunction, kTypes> kDecoders = MakeDecoders(std::make_index_sequence<kTypes>());

const dbc::Signal& Require(const dbc::MessageDefinition& message, std::string_view signal) {
  const dbc::Signal* found = message.Find(signal);
  if (found == nullptr)
    throw std::runtime_error("message " + message.name + " has no signal " + std::string(signal));
  return *found;
}

double RequireNumber(const dbc::MessageDefinition& message, const char* attribute,
                     const dbc::AttributeValue* value, double max) {
  const std::optional<double> number = value != nullptr ? dbc::Number(*value) : std::nullopt;
  if (!number) throw std::runtime_error("message " + message.name + " has no attribute " + attribute);
  if (!(*number >= 0.0 && *number <= max && *number == std::floor(*number))) {
    throw std::runtime_error("attribute " + std::string(attribute) + " of message " + message.name +
                             " is not an integer from 0 to " + std::to_string(static_cast<int>(max)));
  }
  return *number;
}

}  // namespace

struct VehicleBus::Binding {
  dbc::Database database;
  std::vector<MessageInfo> info;       // in the order of `messages`
  std::vector<BoundMessage> messages;  // its pointers point into `database`
  std::array<BoundType, kTypes> types;

  explicit Binding(dbc::Database given) : database(std::move(given)) {
    try {
      BindAll(std::make_index_sequence<kTypes>());
      for (const BoundType& type : types) CheckOverlap(type);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(database.source + ": " + error.what());
    }
  }

  template <std::size_t... kIndices>
  void BindAll(std::index_sequence<kIndices...>) {
    (BindType<kIndices>(), ...);
  }

  template <std::size_t kIndex>
  void BindType() {
    constexpr auto& kLayout = kFields<std::variant_alternative_t<kIndex, Message>>;
    const dbc::MessageDefinition* message = database.Find(std::string_view(kLayout.message));
    if (message == nullptr) throw std::runtime_error(std::string("there is no message ") + kLayout.message);
    BoundType& type = types[kIndex];
    type.message = BindMessage(*message);
    std::apply([&](const auto&... field) { (type.signals.push_back(&Require(*message, field.signal)), ...); },
               kLayout.fields);
    for (const dbc::Signal* signal : type.signals) BindMultiplexor(*message, *signal, type);
    for (const std::size_t other : messages[type.message].types) {
      if (types[other].multiplexor != type.multiplexor ||
          types[other].multiplexor_value == type.multiplexor_value) {
        throw std::runtime_error("message " + message->name + " has no multiplexor to distinguish signal " +
                                 types[other].signals.back()->name + " from " + type.signals.back()->name);
      }
    }
    messages[type.message].types.push_back(kIndex);
  }

  static void BindMultiplexor(const dbc::MessageDefinition& message, const dbc::Signal& signal,
                              BoundType& type) {
    if (!signal.multiplexing) return;
    const dbc::Signal& multiplexor = message.signals[signal.multiplexing->multiplexor];
    const std::vector<dbc::RawRange>& values = signal.multiplexing->values;
    if (multiplexor.multiplexing || values.size() != 1 || values.front().first != values.front().last) {
      throw std::runtime_error("signal " + signal.name + " of message " + message.name +
                               " is multiplexed by more than one value");
    }
    if (type.multiplexor != nullptr && type.multiplexor_value != values.front().first) {
      throw std::runtime_error("signal " + signal.name + " of message " + message.name +
                               " is not in the same frame as the other signals of its struct");
    }
    type.multiplexor = &multiplexor;
    type.multiplexor_value = values.front().first;
  }

  std::size_t BindMessage(const dbc::MessageDefinition& message) {
    for (std::size_t i = 0; i < info.size(); ++i) {
      if (info[i].name == message.name) return i;
    }
    if (message.extended) throw std::runtime_error("message " + message.name + " has an extended id");
    if (message.length > RawMessage{}.data.size()) {
      throw std::runtime_error("message " + message.name + " is longer than 8 bytes");
    }
    BoundMessage bound;
    bound.id = message.id;
    bound.length = message.length;
    bound.crc = &Require(message, kCrcSignal);
    bound.counter = &Require(message, kCounterSignal);
    // The attribute's default is not used: it would give all messages the same data id.
    const auto data_id = message.attributes.find("E2EDataId");
    bound.data_id = static_cast<std::uint16_t>(RequireNumber(
        message, "E2EDataId", data_id != message.attributes.end() ? &data_id->second : nullptr, 65535.0));
    const double period =
        RequireNumber(message, "GenMsgCycleTime", database.Attribute(message, "GenMsgCycleTime"), 1e9);
    CheckProtection(message, bound);
    messages.push_back(bound);
    info.push_back({.id = message.id,
                    .name = message.name,
                    .length = static_cast<std::uint8_t>(message.length),
                    .period = period * 1e-3,
                    .data_id = bound.data_id});
    return messages.size() - 1;
  }

  static void CheckProtection(const dbc::MessageDefinition& message, const BoundMessage& bound) {
    std::array<std::byte, 8> mask{};
    dbc::WriteRaw(*bound.crc, ~std::uint64_t{0}, mask);
    std::array<std::byte, 8> first_byte{std::byte{0xFF}};
    if (mask != first_byte)
      throw std::runtime_error("signal CRC of message " + message.name + " is not byte 0");
    if (bound.counter->length != 4) {
      throw std::runtime_error("signal Counter of message " + message.name + " is not 4 bits long");
    }
  }

  // Throws if two signals that are written into one frame share a bit.
  void CheckOverlap(const BoundType& type) const {
    const BoundMessage& message = messages[type.message];
    std::vector<const dbc::Signal*> signals{message.crc, message.counter};
    if (type.multiplexor != nullptr) signals.push_back(type.multiplexor);
    signals.insert(signals.end(), type.signals.begin(), type.signals.end());
    std::uint64_t taken = 0;
    for (const dbc::Signal* signal : signals) {
      std::array<std::byte, 8> payload{};
      dbc::WriteRaw(*signal, ~std::uint64_t{0}, payload);
      const auto mask = std::bit_cast<std::uint64_t>(payload);
      if ((taken & mask) != 0) {
        throw std::runtime_error("signal " + signal->name + " of message " + info[type.message].name +
                                 " overlaps another one");
      }
      taken |= mask;
    }
  }

  [[nodiscard]] const BoundMessage* Find(std::uint32_t id) const {
    const auto found = std::ranges::find(messages, id, &BoundMessage::id);
    return found == messages.end() ? nullptr : &*found;
  }

  // Index of the typed message in the payload; kTypes if there is none.
  [[nodiscard]] std::size_t FindType(std::uint32_t id, std::span<const std::byte> payload) const {
    const BoundMessage* bound = Find(id);
    if (bound == nullptr || payload.size() < bound->length) return kTypes;
    const auto carried = [&](std::size_t index) {
      const BoundType& type = types[index];
      return type.multiplexor == nullptr ||
             dbc::ReadRaw(*type.multiplexor, payload) == type.multiplexor_value;
    };
    const auto found = std::ranges::find_if(bound->types, carried);
    return found == bound->types.end() ? kTypes : *found;
  }
};

VehicleBus::VehicleBus() : VehicleBus(dbc::Parse(BuiltInDbc(), "vehicle.dbc")) {}
VehicleBus::VehicleBus(dbc::Database database) : binding_(std::make_unique<Binding>(std::move(database))) {}
VehicleBus::~VehicleBus() = default;
VehicleBus::VehicleBus(VehicleBus&&) noexcept = default;
VehicleBus& VehicleBus::operator=(VehicleBus&&) noexcept = default;

dbc::EncodeStatus VehicleBus::Encode(const Message& message, std::uint8_t counter, RawMessage& out) const {
  const BoundType& type = binding_->types[message.index()];
  const BoundMessage& bound = binding_->messages[type.message];
  RawMessage raw{.id = bound.id, .length = static_cast<std::uint8_t>(bound.length), .data = {}};
  const std::span payload(raw.data.data(), bound.length);
  dbc::EncodeStatus status = dbc::EncodeStatus::kOk;
  const auto write = [&](auto member, const dbc::Signal& signal) {
    const dbc::EncodeStatus one = dbc::EncodeSignal(signal, ToPhysical(member), payload);
    if (one != dbc::EncodeStatus::kOk) status = one;
    return one != dbc::EncodeStatus::kNotFinite;
  };
  std::visit([&](const auto& typed) { static_cast<void>(ForEachField(typed, type, write)); }, message);
  if (status == dbc::EncodeStatus::kNotFinite) return status;

  if (type.multiplexor != nullptr) dbc::WriteRaw(*type.multiplexor, type.multiplexor_value, payload);
  dbc::WriteRaw(*bound.counter, counter, payload);
  dbc::WriteRaw(*bound.crc, dbc::E2eProfile1Crc(bound.data_id, payload), payload);
  out = raw;
  return status;
}

E2eCheck VehicleBus::Check(std::uint32_t id, std::span<const std::byte> payload) const {
  const BoundMessage* bound = binding_->Find(id);
  if (bound == nullptr) return {.verdict = E2eVerdict::kUnknownMessage};
  if (payload.size() != bound->length) return {.verdict = E2eVerdict::kWrongLength};
  const std::uint64_t counter = dbc::ReadRaw(*bound->counter, payload);
  E2eCheck check{.verdict = E2eVerdict::kOk, .counter = static_cast<std::uint8_t>(counter)};
  if (dbc::ReadRaw(*bound->crc, payload) != dbc::E2eProfile1Crc(bound->data_id, payload)) {
    check.verdict = E2eVerdict::kWrongCrc;
  } else if (counter >= dbc::kCounterModulus) {
    check.verdict = E2eVerdict::kInvalidCounter;
  }
  return check;
}

std::optional<Message> VehicleBus::Decode(std::uint32_t id, std::span<const std::byte> payload) const {
  const std::size_t index = binding_->FindType(id, payload);
  if (index == kTypes) return std::nullopt;
  return kDecoders[index](binding_->types[index], payload);
}

bool VehicleBus::InRange(std::uint32_t id, std::span<const std::byte> payload) const {
  const std::size_t index = binding_->FindType(id, payload);
  return index == kTypes ||
         std::ranges::all_of(binding_->types[index].signals,
                             [&](const dbc::Signal* signal) { return dbc::InRange(*signal, payload); });
}

const std::vector<MessageInfo>& VehicleBus::messages() const {
  return binding_->info;
}

const MessageInfo* VehicleBus::Find(std::uint32_t id) const {
  const auto found = std::ranges::find(binding_->info, id, &MessageInfo::id);
  return found == binding_->info.end() ? nullptr : &*found;
}

const MessageInfo& VehicleBus::InfoOf(std::size_t type) const {
  return binding_->info[binding_->types[type].message];
}

const dbc::Database& VehicleBus::database() const {
  return binding_->database;
}

}  // namespace bus
