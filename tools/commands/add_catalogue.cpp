#include <iostream>
#include <memory>

#include "tools/catalogue/catalogue.hpp"
#include "tools/commands/command.hpp"

namespace tools {

Command AddCatalogue(CLI::App& program) {
  const auto options = std::make_shared<CatalogueOptions>();
  options->jobs = Processors();
  CLI::App* command = program.add_subcommand("catalogue", "drive the catalogue of scenarios");
  command->add_option("--scenarios", options->folder,
                      "folder with the catalogue, instead of the installed one");
  command->add_option("--filter", options->filter, "drive only the scenarios whose name contains this text");
  AddJobs(*command, options->jobs);
  command->add_option("--json", options->json, "write all figures as JSON to this file");
  command
      ->add_option("--report", options->report,
                   "write a page with all drives to this HTML file; catalogue.html without a name")
      ->expected(0, 1);
  return {.app = command, .run = [command, options] {
            if (command->count("--report") > 0 && options->report.empty()) options->report = "catalogue.html";
            if (options->folder.empty()) options->folder = Scenarios("catalogue");
            return Catalogue(*options, std::cout);
          }};
}

}  // namespace tools
