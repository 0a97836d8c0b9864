// The smoothest path through the gaps of a way: a quadratic program over the stations,
//
//   min   Σ Δt_j (d_j² + w_ψ d'_j² + w_ω (υ_j d''_j)²)
//   s.t.  d_{j+1} = d_j + Δs_j d'_j + ½ Δs_j² d''_j,   d'_{j+1} = d'_j + Δs_j d''_j
//         lo_j ≤ d_j ≤ hi_j  (soft),   |κ_j + d''_j| ≤ κ_max
//
// with the weights of the controller that follows the path, so that it has little to correct.
#pragma once

#include "control/qp/solver.hpp"
#include "control/road/lateral_path.hpp"
#include "control/traffic/corridor.hpp"
#include "control/traffic/speed_plan.hpp"

namespace control {

struct PathSmootherSettings {
  double heading_weight = 10.0;   // w_ψ [m²]
  double yaw_rate_weight = 40.0;  // w_ω [m² s²]
  double max_curvature = 0.2;     // κ_max [1/m]
};

class PathSmoother {
 public:
  explicit PathSmoother(const PathSmootherSettings& settings)
      : settings_(settings), qp_(static_cast<int>(kStations) - 1), solver_(static_cast<int>(kStations) - 1) {}

  // The path begins at `start` and is free behind the stations that the way reaches. `curvature`: of the road at each
  // station [1/m]. False if the problem was not solved; the path is then unchanged.
  [[nodiscard]] bool Smooth(const Stations& stations, const LateralPoint& start, const Way& way,
                            const SpeedPlan& speeds, const StationValues& curvature, LateralPath& path);

 private:
  PathSmootherSettings settings_;
  OcpQp<2, 1> qp_;
  OcpQpSolver<2, 1> solver_;
};

}  // namespace control
