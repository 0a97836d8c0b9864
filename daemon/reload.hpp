// SIGHUP: a running daemon reads its configuration again and takes all that was changed in it, or nothing. Which keys may
// change and when: loop/config_tables.hpp.
//
// The text of a value decides: a key whose default value is written out counts as changed, and so does a key that is
// deleted. Files that the configuration names (route, DBC) are not read again.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "loop/config.hpp"
#include "loop/control_loop.hpp"

namespace lpvmpcd {

// The keys whose values differ, one of them missing included, in alphabetical order.
[[nodiscard]] std::vector<std::string> ChangedKeys(const loop::Config& before, const loop::Config& after);

// Why the key cannot be changed now; empty if it can.
[[nodiscard]] std::string_view WhyNot(std::string_view key, bool commanding);

class Reloader {
 public:
  // `now`: what the daemon runs by. `load` reads it anew, with all that the command line overrides; it throws
  // std::exception. `loop` must outlive the reloader.
  Reloader(loop::Config now, std::function<loop::Config()> load, loop::ControlLoop& loop);

  // Logs one line: what was taken, or why nothing was. Reads files, which may cost the cycle that is under way its
  // deadline, as any pause does.
  void Reload();

 private:
  loop::Config now_;
  std::function<loop::Config()> load_;
  loop::ControlLoop* loop_;
};

}  // namespace lpvmpcd
