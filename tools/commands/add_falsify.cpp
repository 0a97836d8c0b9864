#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iostream>
#include <memory>

#include "tools/commands/command.hpp"
#include "tools/drive/sweep_config.hpp"
#include "tools/falsify/falsify.hpp"

namespace tools {
namespace {

void AddWorst(CLI::App& command, int& worst) {
  command.add_option("--worst", worst, "number of scenarios that are printed")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
}

Command AddMerge(CLI::App& falsify) {
  const auto options = std::make_shared<FalsifyMergeOptions>();
  CLI::App* command = falsify.add_subcommand("merge", "join the parts of a falsification");
  command->add_option("FILE", options->parts, "parts, as falsify --shard wrote them; required");
  command->add_option("--out", options->out, "write all figures as JSON to this file");
  AddWorst(*command, options->worst);
  command->add_flag("--json", options->json, "print all figures as JSON");
  return {.app = command, .run = [command, options] {
            RequireOption(*command, "FILE");
            MergeFalsify(*options, std::cout);
            return 0;
          }};
}

}  // namespace

std::vector<Command> AddFalsify(CLI::App& program) {
  const auto options = std::make_shared<FalsifyOptions>();
  options->jobs = Processors();
  CLI::App* command = program.add_subcommand("falsify", "search for the worst scenarios with traffic")
                          ->require_subcommand(0, 1);
  command->add_option("--budget", options->setup.budget, "number of drives; required")
      ->check(CLI::Range(1, 100'000'000));
  command->add_option("--seed", options->setup.seed, "seed of the searches; required")->check(Seeds());
  AddRanges(*command, options->setup.ranges);
  command
      ->add_option("--controller", options->setup.controller,
                   fmt::format("one of {}", fmt::join(SweepControllers(), ", ")))
      ->capture_default_str();
  AddJobs(*command, options->jobs);
  command->add_option_function<std::string>(
      "--shard", [options](const std::string& text) { options->shard = ParseShard(text); },
      "i/n: make only every n-th search, from the i-th on, and write them, for falsify merge");
  command->add_option("--out", options->out,
                      "write all figures as JSON to this file; with --shard, the part");
  AddWorst(*command, options->worst);
  command->add_flag("--json", options->json, "print all figures as JSON");
  return {AddMerge(*command), {.app = command, .run = [command, options] {
                                 RequireOption(*command, "--budget");
                                 RequireOption(*command, "--seed");
                                 Falsify(*options, std::cout);
                                 return 0;
                               }}};
}

}  // namespace tools
