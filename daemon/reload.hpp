// On SIGHUP a running daemon reads its configuration again and applies either all changes or none.
// loop/config_tables.hpp defines which keys may change and when.
//
// Values are compared as text: a key whose default value is added to the file counts as changed, and so does a deleted
// key. Files that the configuration names (route, DBC) are not read again.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "loop/config.hpp"
#include "loop/control_loop.hpp"

namespace lpvmpcd {

// The keys whose values differ or that only one configuration has, in alphabetical order.
[[nodiscard]] std::vector<std::string> ChangedKeys(const loop::Config& before, const loop::Config& after);

// The reason why the key cannot be changed now; empty if it can.
[[nodiscard]] std::string_view WhyNot(std::string_view key, bool commanding);

class Reloader {
 public:
  // `now`: the configuration in use. `load` reads it again, including the overrides of the command line, and may throw
  // a std::exception. `loop` must outlive the reloader.
  Reloader(loop::Config now, std::function<loop::Config()> load, loop::ControlLoop& loop);

  // Logs one line: what was changed, or why nothing was. Reading the file may cost the present cycle its deadline, as
  // any pause may.
  void Reload();

 private:
  loop::Config now_;
  std::function<loop::Config()> load_;
  loop::ControlLoop* loop_;
};

}  // namespace lpvmpcd
