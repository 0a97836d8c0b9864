// lpvmpcd: steers a vehicle along a route, over CAN.
#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "daemon/log.hpp"
#include "daemon/reload.hpp"
#include "daemon/service.hpp"
#include "loop/assembly.hpp"
#include "loop/config.hpp"

namespace {

constexpr int kRunTimeError = 1;
constexpr int kUsageError = 2;

int Fail(const std::exception& error, int status) {
  std::cerr << "lpvmpcd: " << error.what() << '\n';
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("lpvmpcd: steers a vehicle along a route, over CAN");
  std::string file, interface, controller;
  bool check = false, lockstep = false;
  app.add_option("--config", file, "configuration file (TOML); required");
  app.add_option("--interface", interface, "CAN interface, instead of the configuration's");
  app.add_option("--controller", controller,
                 "lpv-affine, lpv or lpv-standard, instead of the configuration's");
  app.add_flag("--lockstep", lockstep, "count time in cycles, as lpvmpc-sim --lockstep requires");
  app.add_flag("--check-config", check,
               "read the configuration and the files that it names, print a summary and exit");
  app.set_version_flag("--version", "lpvmpcd " LPVMPC_VERSION);
  const auto load = [&] {
    loop::Config config = loop::LoadConfig(file);
    if (!interface.empty()) loop::SelectInterface(config, interface);
    if (!controller.empty()) loop::SelectController(config, controller);
    if (lockstep) loop::SelectLockstep(config);
    return config;
  };
  std::optional<loop::Config> config;
  std::optional<loop::Assembly> assembly;
  try {
    app.parse(argc, argv);
    // CLI11's own check would hide an unknown option.
    if (file.empty()) throw std::runtime_error("--config is required");
    config = load();
    assembly.emplace(*config, base::MonotonicNow);
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : Fail(error, kUsageError);
  } catch (const std::exception& error) {
    return Fail(error, kUsageError);
  }
  if (check) {
    std::cout << "interface " << config->service.interface << ", controller "
              << loop::ControllerName(config->controller) << ", horizon " << loop::HorizonOf(*config)
              << ", period " << config->mpc.t_s << " s, route " << config->route.string() << " with "
              << assembly->reference().size() << " points" << std::endl;
    return std::cout ? 0 : Fail(std::runtime_error("cannot write to stdout"), kRunTimeError);
  }
  try {
    lpvmpcd::OpenLog(config->log_level);
    lpvmpcd::Reloader reloader(*config, load, assembly->loop());
    lpvmpcd::Service service(config->service, assembly->loop(), [&reloader] { reloader.Reload(); });
    service.Run();
    return 0;
  } catch (const std::exception& error) {
    return Fail(error, kRunTimeError);
  }
}
