// The commands of lpvmpc, each with its options and its action.
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
  // Returns the exit status. Throws CLI::ParseError if an option is missing; an exception with a one-line message on
  // bad input.
  std::function<int()> run;
};

// Each adds a command and its options to the program. Subcommands precede their command in the returned list.
[[nodiscard]] Command AddRun(CLI::App& program);
[[nodiscard]] Command AddDecode(CLI::App& program);
[[nodiscard]] std::vector<Command> AddBench(CLI::App& program);
[[nodiscard]] Command AddPaper(CLI::App& program);
[[nodiscard]] std::vector<Command> AddSweep(CLI::App& program);
[[nodiscard]] std::vector<Command> AddFalsify(CLI::App& program);
[[nodiscard]] Command AddCatalogue(CLI::App& program);
[[nodiscard]] Command AddReport(CLI::App& program);

// Helpers that several commands share.

// Throws CLI::RequiredError if `option` was not given. CLI11's own check of required options would hide an unknown one.
void RequireOption(const CLI::App& command, const char* option);
// Adds "--speed LO HI" and "--mu LO HI", which set `ranges`; `ranges` must outlive the command.
void AddRanges(CLI::App& command, ScenarioRanges& ranges);
// Adds "--traffic", likewise.
void AddTraffic(CLI::App& command, ScenarioRanges& ranges);
// Adds "--jobs", the number of processes; `jobs` must outlive the command.
void AddJobs(CLI::App& command, int& jobs);
[[nodiscard]] CLI::Range Seeds();
// The project's scenarios, found relative to the program, both in a build folder and in an installation.
[[nodiscard]] std::filesystem::path Scenarios(const char* part);
[[nodiscard]] std::string ControllerList();
[[nodiscard]] int Processors();

}  // namespace tools
