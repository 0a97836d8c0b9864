// The progress-based reference: it starts at the point of the manoeuvre's path beside the vehicle and is as fast as the
// road profile, the manoeuvre and a comfortable acceleration allow. A vehicle that is late or early is not dragged.
//
// Each state is that of steady cornering on the path (steady_cornering.hpp), so that a bend causes no spurious error:
// ω = κ υ, ψ = ψ_path − ν/υ. It counters the disturbance: δ_ref contains −δ_0 and what a_y requires, a_ref contains −a_x,
// and the vehicle's heading lets the tyres hold a_y. The path at the offset d(s) from the road of curvature κ_r has
//
//   ψ_path = ψ_r + θ,  tan θ = d'/(1 − κ_r d),   κ = (d'' cos²θ/(1 − κ_r d) + κ_r) cos θ/(1 − κ_r d)
//
// where the terms in κ_r d' and in the road's change of curvature are neglected.
#pragma once

#include <span>

#include "control/road/road_profile.hpp"
#include "control/traffic/manoeuvre.hpp"
#include "control/traffic/speed_plan.hpp"
#include "control/vehicle/disturbance.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

class ProgressReference {
 public:
  // `grip`: acceleration that the tyres can give [m/s²].
  ProgressReference(const VehicleParameters& vehicle, const RoadProfile& profile, double t_s, double grip)
      : vehicle_(vehicle), profile_(&profile), t_s_(t_s) {
    SetGrip(grip);
  }

  // The acceleration that the tyres can give from now on [m/s²].
  void SetGrip(double grip) {
    grip_ = grip;
    limits_ = WithinGrip(profile_->limits(), grip);
  }

  // Fills `z` with N + 1 states, `u` with N inputs and `s` with N + 1 arc lengths on the road profile [m], starting
  // at the arc length s_0 and at about the speed `upsilon` [m/s].
  void Fill(double s_0, double upsilon, const Manoeuvre& manoeuvre, std::span<State> z, std::span<Input> u,
            std::span<double> s, const Disturbance& disturbance = {}, bool slow_down = false) const;

 private:
  [[nodiscard]] double Deceleration(double s, double upsilon, const Manoeuvre& manoeuvre) const;
  [[nodiscard]] double SpeedAt(double s, double t, const Manoeuvre& manoeuvre) const;

  VehicleParameters vehicle_;
  const RoadProfile* profile_;
  double grip_ = 0.0;   // [m/s²]
  SpeedLimits limits_;  // the road's, and not more than the tyres can give
  double t_s_;
};

}  // namespace control
