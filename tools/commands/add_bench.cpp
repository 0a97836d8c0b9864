#include <iostream>
#include <memory>

#include "tools/bench/bench_catalogue.hpp"
#include "tools/bench/bench_qp.hpp"
#include "tools/bench/bench_step.hpp"
#include "tools/commands/command.hpp"

namespace tools {
namespace {

Command AddBenchStep(CLI::App& bench) {
  const auto options = std::make_shared<BenchStepOptions>();
  options->scenario = Scenarios("whole_drive/scenario.toml");
  CLI::App* command = bench.add_subcommand("step", "time the whole control step along a drive");
  command->add_option("--scenario", options->scenario, "scenario file (TOML)")->capture_default_str();
  command->add_option("--config", options->config, "daemon's configuration, instead of the scenario's");
  command->add_option("--controller", options->controller,
                      ControllerList() + ", instead of the configuration's");
  command->add_option("--horizon", options->horizons, "one or several horizons N")->capture_default_str();
  command->add_option("--repeat", options->repeat, "number of drives per horizon")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print the figures as JSON");
  return {.app = command, .run = [options] {
            BenchStep(*options, std::cout);
            return 0;
          }};
}

Command AddBenchQp(CLI::App& bench) {
  const auto options = std::make_shared<BenchQpOptions>();
  CLI::App* command = bench.add_subcommand("qp", "time the QP solver on recorded problems");
  command->add_option("DIR", options->folder, "folder with problems *.qp; required");
  command->add_option("--repeat", options->repeat, "number of solves of each problem")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print the figures as JSON");
  return {.app = command, .run = [command, options] {
            RequireOption(*command, "DIR");
            BenchQp(*options, std::cout);
            return 0;
          }};
}

Command AddBenchCatalogue(CLI::App& bench) {
  const auto options = std::make_shared<BenchCatalogueOptions>();
  CLI::App* command =
      bench.add_subcommand("catalogue", "time the whole control cycle in all scenarios of the catalogue");
  command->add_option("--scenarios", options->folder,
                      "folder with the catalogue, instead of the installed one");
  command->add_option("--filter", options->filter, "drive only the scenarios whose name contains this text");
  command->add_option("--horizon", options->horizon, "horizon N")
      ->check(CLI::Range(2, 100))
      ->capture_default_str();
  command->add_option("--objects", options->objects, "number of objects up to which posts are added")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  command->add_option("--repeat", options->repeat, "number of drives of each scenario")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print the figures as JSON");
  return {.app = command, .run = [options] {
            if (options->folder.empty()) options->folder = Scenarios("catalogue");
            BenchCatalogue(*options, std::cout);
            return 0;
          }};
}

}  // namespace

std::vector<Command> AddBench(CLI::App& program) {
  CLI::App* bench = program.add_subcommand("bench", "time parts of the controller")->require_subcommand(0, 1);
  const auto missing = []() -> int {
    throw CLI::RequiredError("a command: bench step, bench catalogue or bench qp");
  };
  return {
      AddBenchStep(*bench), AddBenchCatalogue(*bench), AddBenchQp(*bench), {.app = bench, .run = missing}};
}

}  // namespace tools
