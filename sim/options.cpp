#include "sim/options.hpp"

#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>

namespace sim {

std::optional<Options> ParseOptions(int argc, const char* const* argv, int& exit_code) {
  Options options;
  CLI::App app{"The simulated vehicle of a scenario on a CAN interface.", "lpvmpc-sim"};
  app.add_option("--interface", options.interface, "CAN interface, such as vcan0; required");
  app.add_option("--scenario", options.scenario, "scenario file (TOML); required");
  app.add_flag(
      "--lockstep", options.lockstep,
      "wait for the answer to every state instead of keeping 20 Hz: as fast as both can, repeatable");
  app.add_flag("--json", options.json, "print the summary as JSON");
  app.add_option("--timeout", options.timeout,
                 "seconds to wait for the controller's first frame, 0.1 to 3600")
      ->capture_default_str();
  app.footer("Exit status: 0 expectations met, 1 not met or the run failed, 2 bad usage or input.");
  try {
    app.parse(argc, argv);
    // CLI11's own check would hide an unknown option.
    for (const char* name : {"--interface", "--scenario"}) {
      if (app.count(name) == 0) throw CLI::RequiredError(name);
    }
    // CLI11's own check of a range accepts NaN.
    if (!(options.timeout >= 0.1 && options.timeout <= 3600.0)) {
      throw CLI::ValidationError(
          "--timeout", app.get_option("--timeout")->as<std::string>() + " is outside [0.1, 3600] s");
    }
    return options;
  } catch (const CLI::CallForHelp& help) {
    exit_code = app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::string text = error.what();
    std::ranges::replace(text, '\n', ' ');
    std::fprintf(stderr, "lpvmpc-sim: %s (see --help)\n", text.c_str());
    exit_code = 2;
  }
  return std::nullopt;
}

}  // namespace sim
