// What the vehicle is going to do in the next seconds about everything else on the road, and why.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "control/road/lateral_path.hpp"
#include "control/traffic/corridor.hpp"
#include "control/traffic/manoeuvre_status.hpp"
#include "control/traffic/road_object.hpp"
#include "control/traffic/stop_line.hpp"

namespace control {

struct Manoeuvre {
  static constexpr std::size_t kMostStops = 4;

  Decision decision = Decision::kDrive;
  Reason reason = Reason::kWayFree;
  int object = -1;            // id of the object that decides; -1: none
  Side passed = Side::kNone;  // on which that object is passed; kNone: it is not
  LateralPath path;
  StationValues speed_limit{};  // at the path's stations [m/s]
  StationValues play{};         // lateral freedom of the vehicle's centre there [m]
  StationValues share{};        // of the usual margin that the road's edges get there, 0..1
  std::array<StopLine, kMostStops> stop_lines{};
  std::size_t stop_count = 0;
  std::array<std::size_t, kMostStops> stop_objects{};  // the road object behind each stop line
  std::span<const RoadObject> objects;                 // those that matter, by distance
  std::array<Side, RoadObjects::kMost> side{};         // on which each of them is passed
  std::array<double, RoadObjects::kMost> margin{};     // that is kept to it [m]
  std::size_t left_out = 0;  // objects that matter but are beyond the number that can be considered

  [[nodiscard]] std::span<const StopLine> stops() const { return {stop_lines.data(), stop_count}; }
  // υ² is linear between stations; behind the last one there is no limit. [m/s]
  [[nodiscard]] double SpeedLimitAt(double s) const;
  // The part of a margin that is kept at arc length s [m]: where there is hardly any play, margins give way to it, so that
  // noise does not turn the wheel.
  [[nodiscard]] double Yielding(double s, double usual) const;
  // The margin to the road's edges at arc length s [m], of the usual one.
  [[nodiscard]] double RoadMarginAt(double s, double usual) const;

 private:
  // The lesser value of the two stations that s lies between.
  [[nodiscard]] double LeastAround(const StationValues& values, double s) const;
};

}  // namespace control
