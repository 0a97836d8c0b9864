#include "tools/make_controller.hpp"

#include "control/lpv_mpc.hpp"
#include "control/nmpc.hpp"

namespace tools {

std::unique_ptr<control::Controller> MakeController(const lpvmpcd::Config& config) {
  if (config.controller == lpvmpcd::ControllerKind::kNmpc) {
    const control::MpcSettings& shared = config.mpc;
    control::NmpcSettings settings;
    static_cast<control::MpcSettings&>(settings) = shared;
    return std::make_unique<control::Nmpc>(config.vehicle, settings);
  }
  return std::make_unique<control::LpvMpc>(config.vehicle, config.mpc);
}

}  // namespace tools
