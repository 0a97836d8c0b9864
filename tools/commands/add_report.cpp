#include <memory>

#include "tools/commands/command.hpp"
#include "tools/report/report.hpp"

namespace tools {

Command AddReport(CLI::App& program) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command = program.add_subcommand("report", "write an HTML page about a run");
  command->add_option("RUN_DIR", options->run_dir, "folder written by lpvmpc run, paper or sweep; required");
  command->add_option("-o,--output", options->output, "HTML file to write; required");
  return {.app = command, .run = [command, options] {
            RequireOption(*command, "RUN_DIR");
            RequireOption(*command, "--output");
            Report(*options);
            return 0;
          }};
}

}  // namespace tools
