// The tables and keys of the daemon's configuration file. The reading of the file, the manual page lpvmpcd.toml(5) and
// what a running daemon may reload all follow from them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "loop/config_key.hpp"

namespace loop {

struct ConfigTable {
  std::string name;
  std::string remark;  // for the manual, one or more sentences; may be empty
  std::vector<ConfigKey> keys;
};

// In the order in which they are read and described: a key whose bounds depend on another comes after it.
[[nodiscard]] std::vector<ConfigTable> ConfigTables();

// When a running daemon may take a change of this key, "TABLE.NAME".
[[nodiscard]] Reload ReloadOf(std::string_view key);

}  // namespace loop
