// lpvmpc: offline commands about the controller, a file each.
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>

#include "config/toml_table.hpp"
#include "tools/bench_step.hpp"
#include "tools/decode.hpp"
#include "tools/run.hpp"

namespace {

constexpr int kRunTimeError = 1;
constexpr int kUsageError = 2;

int Fail(const std::exception& error, int status) {
  std::cerr << "lpvmpc: " << error.what() << '\n';
  return status;
}

int Decode(const std::string& log) {
  if (log == "-") return tools::RunDecode(std::cin, "standard input", std::cout, std::cerr);
  std::ifstream file(log);
  if (!file) throw std::runtime_error("cannot read " + log);
  return tools::RunDecode(file, log, std::cout, std::cerr);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("lpvmpc: offline commands about the controller");
  app.require_subcommand(1);
  app.set_version_flag("--version", "lpvmpc " LPVMPC_VERSION);

  tools::RunOptions run;
  CLI::App* run_command = app.add_subcommand("run", "drive a scenario in memory, without a bus");
  run_command->add_option("--scenario", run.scenario, "scenario in TOML")->required();
  run_command->add_option("--config", run.config, "daemon's configuration, instead of the scenario's");
  run_command->add_option("--controller", run.controller,
                          "lpv or lpv-standard, instead of the configuration's");
  run_command->add_option("--log", run.log, "write every frame to this candump log");
  run_command->add_flag("--json", run.json, "summary as JSON");

  std::string log = "-";
  CLI::App* decode_command = app.add_subcommand("decode", "candump text to physical values");
  decode_command->add_option("LOG", log, "candump log; - for standard input")->capture_default_str();

  tools::BenchStepOptions bench;
  bench.scenario = LPVMPC_DATA_DIR "/scenarios/demo/scenario.toml";
  CLI::App* bench_command =
      app.add_subcommand("bench", "time parts of the controller")->require_subcommand(1);
  CLI::App* step_command = bench_command->add_subcommand("step", "the whole control step along a drive");
  step_command->add_option("--scenario", bench.scenario, "scenario in TOML")->capture_default_str();
  step_command->add_option("--config", bench.config, "daemon's configuration, instead of the scenario's");
  step_command->add_option("--horizon", bench.horizons, "N, one or several")->capture_default_str();
  step_command->add_option("--repeat", bench.repeat, "drives per horizon")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  step_command->add_flag("--json", bench.json, "figures as JSON");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : Fail(error, kUsageError);
  }
  try {
    if (run_command->parsed()) return tools::Run(run, std::cout);
    if (decode_command->parsed()) return Decode(log);
    tools::BenchStep(bench, std::cout);
    return 0;
  } catch (const config::ConfigError& error) {
    return Fail(error, kUsageError);
  } catch (const std::exception& error) {
    return Fail(error, kRunTimeError);
  }
}
