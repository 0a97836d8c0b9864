#include <iostream>
#include <memory>

#include "tools/commands/command.hpp"
#include "tools/commands/run.hpp"

namespace tools {

Command AddRun(CLI::App& program) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = program.add_subcommand("run", "drive a scenario in memory, without a bus");
  CLI::Option* scenario = command->add_option("--scenario", options->scenario, "scenario file (TOML)");
  CLI::Option* sweep_seed = command
                                ->add_option("--sweep-seed", options->sweep_seed,
                                             "drive the scenario of this seed, as a sweep draws it")
                                ->check(Seeds())
                                ->excludes(scenario);
  CLI::Option* traffic_key = command
                                 ->add_option("--traffic-key", options->traffic_key,
                                              "drive the scenario with traffic that falsify names so")
                                 ->excludes(scenario)
                                 ->excludes(sweep_seed);
  AddRanges(*command, options->ranges);
  AddTraffic(*command, options->ranges);
  command->get_option("--traffic")->needs(sweep_seed);
  command->add_option("--config", options->config, "daemon's configuration, instead of the scenario's")
      ->excludes(sweep_seed)
      ->excludes(traffic_key);
  command->add_option("--controller", options->controller,
                      ControllerList() + ", instead of the configuration's");
  command->add_option("--log", options->log, "write every frame to this candump log");
  command
      ->add_option("--out", options->out,
                   "write candump.log, summary.json, drive.toml and report.html into this folder")
      ->excludes("--log");
  command->add_option("--record-qp", options->record_qp,
                      "write every quadratic problem of the controller into this folder, for bench qp");
  command->add_flag("--json", options->json, "print the summary as JSON");
  return {.app = command, .run = [command, options] {
            if (!options->drawn()) {
              for (const char* range : {"--speed", "--mu"}) {
                if (command->count(range) > 0)
                  throw CLI::RequiresError(range, "--sweep-seed or --traffic-key");
              }
              RequireOption(*command, "--scenario");
            }
            return Run(*options, std::cout);
          }};
}

}  // namespace tools
