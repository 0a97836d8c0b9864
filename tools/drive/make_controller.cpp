#include "tools/drive/make_controller.hpp"

#include "control/mpc/timed_controller.hpp"
#include "control/nmpc/affine_nmpc.hpp"
#include "control/nmpc/nmpc.hpp"

namespace tools {

std::unique_ptr<control::Controller> MakeController(const loop::Config& config, const loop::Road& road) {
  if (config.controller == loop::ControllerKind::kNmpc) {
    const control::MpcSettings& shared = config.mpc;
    control::NmpcSettings settings;
    static_cast<control::MpcSettings&>(settings) = shared;
    // The computer's speed must not change the drive: only the iteration limit ends a solve.
    settings.max_cpu_time = 1e6;
    return std::make_unique<control::TimedController>(
        std::make_unique<control::Nmpc>(config.vehicle, settings), road.reference, road.profile.edges());
  }
  if (config.controller == loop::ControllerKind::kNmpcAffine) {
    return std::make_unique<control::AffineNmpc>(config.vehicle, road.profile, config.affine);
  }
  return loop::MakeController(config, road);
}

}  // namespace tools
