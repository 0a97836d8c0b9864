#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iostream>
#include <memory>

#include "tools/commands/command.hpp"
#include "tools/drive/sweep_config.hpp"
#include "tools/sweep/sweep.hpp"

namespace tools {
namespace {

Command AddMerge(CLI::App& sweep) {
  const auto options = std::make_shared<SweepMergeOptions>();
  CLI::App* command = sweep.add_subcommand("merge", "join the parts of a sweep");
  command->add_option("FILE", options->parts, "parts, as sweep --shard wrote them; required");
  command->add_option("--out", options->out,
                      "write sweep.json, timing.json, report.json and report.html into this folder");
  command->add_flag("--json", options->json, "print all figures as JSON");
  return {.app = command, .run = [command, options] {
            RequireOption(*command, "FILE");
            MergeSweep(*options, std::cout);
            return 0;
          }};
}

}  // namespace

std::vector<Command> AddSweep(CLI::App& program) {
  const auto options = std::make_shared<SweepOptions>();
  options->jobs = Processors();
  options->setup.controllers = SweepControllers();
  CLI::App* command =
      program.add_subcommand("sweep", "drive many random scenarios")->require_subcommand(0, 1);
  command->add_option("--count", options->setup.count, "number of scenarios; required")
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--seed", options->setup.seed, "seed of the sweep; required")->check(Seeds());
  AddRanges(*command, options->setup.ranges);
  AddTraffic(*command, options->setup.ranges);
  command
      ->add_option("--controller", options->setup.controllers,
                   fmt::format("one or several of {}", fmt::join(SweepControllers(), ", ")))
      ->default_str("all");
  AddJobs(*command, options->jobs);
  command->add_option_function<std::string>(
      "--shard", [options](const std::string& text) { options->shard = ParseShard(text); },
      "i/n: drive only the i-th of n parts and write it, for sweep merge");
  command->add_option(
      "--out", options->out,
      "write sweep.json, timing.json, report.json and report.html into this folder; with --shard, "
      "the part to this file");
  command->add_flag("--json", options->json, "print all figures as JSON");
  return {AddMerge(*command), {.app = command, .run = [command, options] {
                                 RequireOption(*command, "--count");
                                 RequireOption(*command, "--seed");
                                 Sweep(*options, std::cout);
                                 return 0;
                               }}};
}

}  // namespace tools
