#include "tools/make_controller.hpp"

#include "control/affine_nmpc.hpp"
#include "control/nmpc.hpp"
#include "daemon/assembly.hpp"

namespace tools {

std::unique_ptr<control::Controller> MakeController(const lpvmpcd::Config& config,
                                                    const control::Course& course) {
  if (config.controller == lpvmpcd::ControllerKind::kNmpc) {
    const control::MpcSettings& shared = config.mpc;
    control::NmpcSettings settings;
    static_cast<control::MpcSettings&>(settings) = shared;
    settings.max_cpu_time =
        1e6;  // what a computer takes for a step must not change the drive: its iterations end it
    return std::make_unique<control::Nmpc>(config.vehicle, settings);
  }
  if (config.controller == lpvmpcd::ControllerKind::kNmpcAffine) {
    return std::make_unique<control::AffineNmpc>(config.vehicle, course, config.affine);
  }
  return lpvmpcd::MakeController(config, course);
}

}  // namespace tools
