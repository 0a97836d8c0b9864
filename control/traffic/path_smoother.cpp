#include "control/traffic/path_smoother.hpp"

#include <algorithm>
#include <cmath>

namespace control {
namespace {

// Weights of the slack of a gap's bounds [1/m], [1/m²].
constexpr double kSoft = 2e3;
constexpr double kLeastBound = 1e-3;  // least freedom of the curvature [1/m]

struct Interval {
  double lo, hi;
};

// A gap holds between its station and the one before: at a station, the path stays within both gaps that meet there.
Interval Bounds(const Way& way, std::size_t j) {
  const Gap& gap = way.gap[j];
  const Interval own{.lo = gap.lo, .hi = std::max(gap.lo, gap.hi)};
  if (j + 1 >= way.reached) return own;
  const Interval both{.lo = std::max(own.lo, way.gap[j + 1].lo), .hi = std::min(own.hi, way.gap[j + 1].hi)};
  return both.lo <= both.hi ? both : own;
}

}  // namespace

bool PathSmoother::Smooth(const Stations& stations, const LateralPoint& start, const Way& way,
                          const SpeedPlan& speeds, const StationValues& curvature, LateralPath& path) {
  qp_.x0 << start.offset, start.slope;
  double speed = std::max(speeds.v[0], 1.0);
  for (std::size_t j = 0; j < kStations; ++j) {
    auto& stage = qp_.stages[j];
    stage.ClearRows();
    const bool reached = j < speeds.count;
    if (reached) speed = std::max(speeds.v[j], 1.0);
    const double ds = stations.Step(j), dt = ds / speed;
    stage.Q << 2.0 * dt, 2.0 * dt * settings_.heading_weight;
    if (j > 0 && j < way.reached) {
      const auto [lo, hi] = Bounds(way, j);
      if (!stage.AddStateBound(0, lo, hi, kSoft, kSoft)) return false;
    }
    if (j + 1 == kStations) break;
    stage.A << 1.0, ds, 0.0, 1.0;
    stage.B << 0.5 * ds * ds, ds;
    stage.c.setZero();
    stage.R[0] = 2.0 * dt * settings_.yaw_rate_weight * speed * speed;
    const double most = settings_.max_curvature;
    if (!stage.AddInputBound(0, std::min(-most - curvature[j], -kLeastBound),
                             std::max(most - curvature[j], kLeastBound))) {
      return false;
    }
  }
  if (solver_.Solve(qp_).status != SolverStatus::kSolved) return false;
  path.stations = stations;
  path.exists = true;
  const auto& solved = solver_.solution().stages;
  for (std::size_t j = 0; j < kStations; ++j) {
    path.offset[j] = solved[j].x[0];
    path.slope[j] = solved[j].x[1];
    path.bend[j] = j + 1 < kStations ? solved[j].u[0] : 0.0;
  }
  return true;
}

}  // namespace control
