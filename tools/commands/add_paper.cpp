#include <iostream>
#include <memory>

#include "tools/commands/command.hpp"
#include "tools/paper/paper.hpp"

namespace tools {

Command AddPaper(CLI::App& program) {
  const auto options = std::make_shared<PaperOptions>();
  options->scenarios = Scenarios("paper");
  options->jobs = Processors();
  CLI::App* command = program.add_subcommand("paper", "repeat the paper's comparisons and judge its claims");
  command->add_option("--out", options->out,
                      "write report.html, report.json and paper.json into this folder");
  command->add_flag("--map", options->map,
                    "sweep speed, sideways shift and horizon as well: hundreds of drives");
  command->add_option("--jobs", options->jobs, "number of processes that drive the map")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_option("--repeat", options->repeat, "number of drives; of each step the least time counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--scenarios", options->scenarios, "folder with the paper's scenarios")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print all figures as JSON");
  return {.app = command, .run = [options] { return Paper(*options, std::cout); }};
}

}  // namespace tools
