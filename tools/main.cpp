// lpvmpc: offline commands about the controller.
#include <iostream>
#include <stdexcept>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/commands/command.hpp"

namespace {

constexpr int kBadInput = 2;

std::vector<tools::Command> AddCommands(CLI::App& program) {
  std::vector<tools::Command> commands{tools::AddRun(program), tools::AddDecode(program)};
  const auto add = [&commands](const std::vector<tools::Command>& more) {
    commands.insert(commands.end(), more.begin(), more.end());
  };
  add(tools::AddBench(program));
  commands.push_back(tools::AddPaper(program));
  add(tools::AddSweep(program));
  add(tools::AddFalsify(program));
  commands.push_back(tools::AddCatalogue(program));
  commands.push_back(tools::AddReport(program));
  return commands;
}

int RunParsed(const std::vector<tools::Command>& commands) {
  for (const tools::Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  throw CLI::RequiredError("a command: run, decode, bench, paper, sweep, falsify, catalogue or report");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("lpvmpc: offline commands about the controller");
  program.require_subcommand(0, 1);
  program.footer(
      "Exit status: 0 success; 1 expectations not met, or invalid lines in a log; 2 invalid usage, input or "
      "output.");
  program.set_version_flag("--version", "lpvmpc " LPVMPC_VERSION);
  const std::vector<tools::Command> commands = AddCommands(program);
  int status = 0;
  try {
    try {
      program.parse(argc, argv);
      status = RunParsed(commands);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() != 0) throw;
      status = program.exit(error);  // --help and --version
    }
    if (!std::cout.flush()) throw std::runtime_error("standard output: cannot be written");
  } catch (const std::exception& error) {
    std::cerr << "lpvmpc: " << error.what() << '\n';
    return kBadInput;
  }
  return status;
}
