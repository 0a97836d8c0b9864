#include "dbc/database.hpp"

#include <algorithm>

namespace dbc {

const Signal* MessageDefinition::Find(std::string_view signal_name) const {
  const auto found = std::ranges::find(signals, signal_name, &Signal::name);
  return found == signals.end() ? nullptr : &*found;
}

const MessageDefinition* Database::Find(std::string_view message_name) const {
  const auto found = std::ranges::find(messages, message_name, &MessageDefinition::name);
  return found == messages.end() ? nullptr : &*found;
}

const MessageDefinition* Database::Find(std::uint32_t id, bool extended) const {
  const auto found = std::ranges::find_if(
      messages, [&](const MessageDefinition& m) { return m.id == id && m.extended == extended; });
  return found == messages.end() ? nullptr : &*found;
}

const AttributeValue* Database::Attribute(const MessageDefinition& message, std::string_view name) const {
  if (const auto own = message.attributes.find(name); own != message.attributes.end()) return &own->second;
  const auto definition = attribute_definitions.find(name);
  if (definition == attribute_definitions.end()) return nullptr;
  const std::optional<AttributeValue>& value = definition->second.default_value;
  return value ? &*value : nullptr;
}

std::optional<double> Number(const AttributeValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  if (const auto* real = std::get_if<double>(&value)) return *real;
  return std::nullopt;
}

}  // namespace dbc
