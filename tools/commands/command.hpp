// The commands of lpvmpc, each with its options and what it does.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/scenarios/scenario_ranges.hpp"

namespace tools {

struct Command {
  CLI::App* app = nullptr;
  std::function<int()>
      run;  // exit status; throws CLI::ParseError if an option is missing, or one line at bad input
};

// Each adds a command to the program, with its options; of a command with commands of its own these come first.
[[nodiscard]] Command AddRun(CLI::App& program);
[[nodiscard]] Command AddDecode(CLI::App& program);
[[nodiscard]] std::vector<Command> AddBench(CLI::App& program);
[[nodiscard]] Command AddPaper(CLI::App& program);
[[nodiscard]] std::vector<Command> AddSweep(CLI::App& program);
[[nodiscard]] Command AddReport(CLI::App& program);

// What several of them share.

// CLI11's own check of a required option would hide an unknown one.
void RequireOption(const CLI::App& command, const char* option);
// "--speed LO HI" and "--mu LO HI" into `ranges`, which must outlive the command.
void AddRanges(CLI::App& command, ScenarioRanges& ranges);
[[nodiscard]] CLI::Range Seeds();
// The project's scenarios beside the program: in the folder of a build as where it is installed.
[[nodiscard]] std::filesystem::path Scenarios(const char* part);
[[nodiscard]] std::string ControllerList();
[[nodiscard]] int Processors();

}  // namespace tools
