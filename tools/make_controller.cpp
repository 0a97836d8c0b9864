#include "tools/make_controller.hpp"

#include "control/lpv_mpc.hpp"

namespace tools {

std::unique_ptr<control::Controller> MakeController(const lpvmpcd::Config& config) {
  return std::make_unique<control::LpvMpc>(config.vehicle, config.mpc);
}

}  // namespace tools
