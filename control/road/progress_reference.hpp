// The progress-based reference: it starts at the point of the road profile beside the vehicle and is as fast as the
// profile, the stop lines and a comfortable acceleration allow. A vehicle that is late or early is not dragged.
//
// Each state is that of steady cornering on the road profile (steady_cornering.hpp), so that a bend causes no
// spurious error: ω = κ υ, ψ = ψ_road − ν/υ.
#pragma once

#include <span>

#include "control/road/road_profile.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// A line across the road that must not be passed; it may move along the road.
struct StopLine {
  double s = 0.0;      // current arc length [m]
  double speed = 0.0;  // ≥ 0 [m/s]
};

class ProgressReference {
 public:
  ProgressReference(const VehicleParameters& vehicle, const RoadProfile& profile, double t_s)
      : vehicle_(vehicle), profile_(&profile), t_s_(t_s) {}

  // Fills `z` with N + 1 states, `u` with N inputs and `s` with N + 1 arc lengths on the road profile [m], starting
  // at the arc length s_0 and at about the speed `upsilon` [m/s].
  void Fill(double s_0, double upsilon, std::span<const StopLine> stops, std::span<State> z,
            std::span<Input> u, std::span<double> s) const;

 private:
  [[nodiscard]] double Deceleration(double s, double upsilon, std::span<const StopLine> stops) const;
  [[nodiscard]] double SpeedAt(double s, double t, std::span<const StopLine> stops) const;

  VehicleParameters vehicle_;
  const RoadProfile* profile_;
  double t_s_;
};

}  // namespace control
