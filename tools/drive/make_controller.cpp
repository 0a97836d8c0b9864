#include "tools/drive/make_controller.hpp"

#include "control/nmpc/affine_nmpc.hpp"
#include "control/nmpc/nmpc.hpp"
#include "loop/assembly.hpp"

namespace tools {

std::unique_ptr<control::Controller> MakeController(const loop::Config& config,
                                                    const control::RoadProfile& course) {
  if (config.controller == loop::ControllerKind::kNmpc) {
    const control::MpcSettings& shared = config.mpc;
    control::NmpcSettings settings;
    static_cast<control::MpcSettings&>(settings) = shared;
    settings.max_cpu_time =
        1e6;  // what a computer takes for a step must not change the drive: its iterations end it
    return std::make_unique<control::Nmpc>(config.vehicle, settings);
  }
  if (config.controller == loop::ControllerKind::kNmpcAffine) {
    return std::make_unique<control::AffineNmpc>(config.vehicle, course, config.affine);
  }
  return loop::MakeController(config, course);
}

}  // namespace tools
