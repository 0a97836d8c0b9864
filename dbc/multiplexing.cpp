#include "dbc/multiplexing.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace dbc {
namespace {

std::size_t FindMultiplexor(const TokenReader& in, const MessageDefinition& message, const SignalNote& note) {
  const std::string& wanted = note.multiplexor;
  const auto fits = [&wanted](const Signal& s) {
    return wanted.empty() ? s.is_multiplexor && !s.multiplexing : s.name == wanted;
  };
  const auto count = std::ranges::count_if(message.signals, fits);
  if (count == 1) {
    return static_cast<std::size_t>(std::ranges::find_if(message.signals, fits) - message.signals.begin());
  }
  const std::string subject = "signal " + note.place.text + " is multiplexed";
  if (!wanted.empty())
    in.Fail(note.place, subject + " by " + wanted + ", which is not in message " + message.name);
  in.Fail(note.place, subject + ", but message " + message.name + " has " + std::to_string(count) +
                          " multiplexors, expected 1");
}

}  // namespace

void ResolveMultiplexing(const TokenReader& in, const std::vector<SignalNote>& notes,
                         MessageDefinition& message) {
  std::vector<Signal>& all = message.signals;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::optional<Multiplexing>& multiplexing = all[i].multiplexing;
    if (multiplexing) multiplexing->multiplexor = FindMultiplexor(in, message, notes[i]);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::size_t steps = 0;
    for (const Signal* s = &all[i]; s->multiplexing; s = &all[s->multiplexing->multiplexor]) {
      if (++steps <= all.size()) continue;
      in.Fail(notes[i].place, "the multiplexors of signal " + all[i].name + " are circular");
    }
  }
}

}  // namespace dbc
