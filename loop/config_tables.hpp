// The tables and keys of the daemon's configuration file. They determine how the file is read, the manual page
// lpvmpcd.toml(5) and what a running daemon may reload.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "loop/config_key.hpp"

namespace loop {

struct ConfigTable {
  std::string name;
  std::string remark;  // sentences for the manual; may be empty
  std::vector<ConfigKey> keys;
};

// Tables in the order of reading and of the manual: a key whose bounds depend on another one comes after it.
[[nodiscard]] std::vector<ConfigTable> ConfigTables();

// When a running daemon may apply a change of this key, "TABLE.NAME"; kNeedsRestart for an unknown key.
[[nodiscard]] Reload ReloadOf(std::string_view key);

}  // namespace loop
