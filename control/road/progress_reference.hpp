// The reference by progress: from the point of the course beside the vehicle on, as fast as the course's profile, what
// may stand in the way, and a comfortable acceleration allow. A vehicle that is late or early is not dragged.
//
// Each state is that of steady cornering on the course (steady_cornering.hpp), so that on a bend no error remains that is
// none: ω = κ υ, ψ = ψ_course − ν/υ.
#pragma once

#include <span>

#include "control/road/road_profile.hpp"
#include "control/vehicle/types.hpp"
#include "control/vehicle/vehicle_parameters.hpp"

namespace control {

// A place that must not be passed, moving along the course.
struct StopLine {
  double s = 0.0;      // now [m]
  double speed = 0.0;  // ≥ 0 [m/s]
};

class ProgressReference {
 public:
  ProgressReference(const VehicleParameters& vehicle, const RoadProfile& course, double t_s)
      : vehicle_(vehicle), course_(&course), t_s_(t_s) {}

  // `z`: N + 1 states, `u`: N inputs, `s`: the N + 1 places on the course [m]. From the place s_0 and at about the speed
  // `upsilon` [m/s].
  void Fill(double s_0, double upsilon, std::span<const StopLine> stops, std::span<State> z,
            std::span<Input> u, std::span<double> s) const;

 private:
  [[nodiscard]] double Deceleration(double s, double upsilon, std::span<const StopLine> stops) const;
  [[nodiscard]] double SpeedAt(double s, double t, std::span<const StopLine> stops) const;

  VehicleParameters vehicle_;
  const RoadProfile* course_;
  double t_s_;
};

}  // namespace control
