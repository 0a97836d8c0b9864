// Prints the keys of the daemon's configuration as sections of lpvmpcd.toml(5), in the language of scdoc.
#include <fmt/core.h>
#include <string>
#include <utility>

#include "loop/config_tables.hpp"

namespace {

std::string WithSuperscripts(std::string text) {
  for (const auto& [plain, raised] : {std::pair{"^2", "²"}, std::pair{"^3", "³"}}) {
    for (std::size_t at = text.find(plain); at != std::string::npos; at = text.find(plain)) {
      text.replace(at, 2, raised);
    }
  }
  return text;
}

const char* ReloadText(loop::Reload reload) {
  switch (reload) {
    case loop::Reload::kNeedsRestart:
      return "";
    case loop::Reload::kWhileNotCommanding:
      return " Reloaded while no commands are enabled.";
    case loop::Reload::kAlways:
      return " Reloaded at any time.";
  }
  return "";
}

}  // namespace

int main() {
  for (const loop::ConfigTable& table : loop::ConfigTables()) {
    fmt::print("# [{}]\n\n", table.name);
    if (!table.remark.empty()) fmt::print("{}\n\n", table.remark);
    for (const loop::ConfigKey& key : table.keys) {
      const std::string allowed =
          key.allowed.empty() ? "" : fmt::format(" Allowed: {}.", WithSuperscripts(key.allowed));
      fmt::print("*{}* = {}\n\t{}.{}{}\n\n", key.name, key.default_value, key.sentence, allowed,
                 ReloadText(key.reload));
    }
  }
}
