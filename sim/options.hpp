// The command line of lpvmpc-sim.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace sim {

struct Options {
  std::string interface;
  std::filesystem::path scenario;
  bool lockstep = false;
  bool json = false;
  double timeout = 10.0;  // wait for the controller [s]
};

// Returns nullopt if the program must end at once with `exit_code`: 0 after --help, 2 after a usage error, which has
// been reported in one line on stderr.
[[nodiscard]] std::optional<Options> ParseOptions(int argc, const char* const* argv, int& exit_code);

}  // namespace sim
