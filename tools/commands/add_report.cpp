#include <memory>

#include "tools/commands/command.hpp"
#include "tools/report/report.hpp"

namespace tools {

Command AddReport(CLI::App& program) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command = program.add_subcommand("report", "a page about a run, for any browser");
  command->add_option("RUN_DIR", options->run_dir, "folder of a drive or of lpvmpc paper; required");
  command->add_option("-o,--output", options->output, "HTML file to write; required");
  return {.app = command, .run = [command, options] {
            RequireOption(*command, "RUN_DIR");
            RequireOption(*command, "--output");
            Report(*options);
            return 0;
          }};
}

}  // namespace tools
