#include "tools/drive/scenario_config.hpp"

#include "config/toml_table.hpp"

namespace tools {

loop::Config LoadConfigFor(const sim::Scenario& scenario, const std::filesystem::path& scenario_file,
                           const std::filesystem::path& file) {
  const std::filesystem::path& config_file = file.empty() ? scenario.daemon_config : file;
  if (config_file.empty()) {
    throw config::ConfigError(scenario_file.string() + ": names no daemon_config; give one by --config");
  }
  return loop::LoadConfig(config_file);
}

}  // namespace tools
