#include "tools/report/report_data.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "bus/names.hpp"
#include "control/road/projection.hpp"
#include "tools/report/object_data.hpp"
#include "tools/report/rounded.hpp"

namespace tools {
namespace {

using nlohmann::ordered_json;

// Overhang beyond each axle and width of a mid-size car [m].
constexpr double kOverhang = 0.9;
constexpr double kWidth = 1.8;

// One series over all samples; null where `value` returns NaN.
template <typename Value>
ordered_json Series(const DriveRecord& record, int decimals, const Value& value) {
  ordered_json series = ordered_json::array();
  for (const DriveSample& sample : record.samples) {
    const double number = value(sample);
    series.push_back(std::isnan(number) ? ordered_json(nullptr) : ordered_json(Rounded(number, decimals)));
  }
  return series;
}

// NaN in cycles without a problem to solve, otherwise `value`.
template <typename Value>
auto IfSolving(const Value& value) {
  return [value](const DriveSample& sample) {
    return sample.status.solver_status == bus::SolverStatus::kNone ? std::nan("") : value(sample);
  };
}

ordered_json OutlineData(const control::Footprint& footprint, const control::VehicleParameters& vehicle) {
  if (footprint.front + footprint.rear + footprint.half_width > 0.0) {
    return {{"front", footprint.front}, {"rear", footprint.rear}, {"width", 2.0 * footprint.half_width}};
  }
  return {{"front", vehicle.l_f + kOverhang}, {"rear", vehicle.l_r + kOverhang}, {"width", kWidth}};
}

// The arc length of the course beside the vehicle at each sample [m]. Each is searched near the one before, the first near
// the start if that is not much farther from the vehicle than any other part of the course: a circuit ends where it begins.
std::vector<double> Progress(const DriveRecord& record, const control::Route& route) {
  constexpr double kFarther = 1.0;  // [m]
  std::vector<double> progress;
  for (const DriveSample& sample : record.samples) {
    const Eigen::Vector2d position(sample.z[control::kX], sample.z[control::kY]);
    const control::RouteProjection near = route.Project(position, progress.empty() ? 0.0 : progress.back());
    double s = near.s;
    if (progress.empty()) {
      const control::RouteProjection nearest = route.Project(position);
      if (std::abs(near.lateral) > std::abs(nearest.lateral) + kFarther) s = nearest.s;
    }
    progress.push_back(s);
  }
  return progress;
}

ordered_json DecisionsData(const DriveRecord& record) {
  ordered_json decisions = ordered_json::array();
  for (const RecordedDecision& decision : record.decisions) {
    decisions.push_back({{"t", Rounded(record.Time(decision.cycle), 2)},
                         {"decision", bus::DecisionText(decision.manoeuvre)},
                         {"reason", bus::Name(decision.manoeuvre.reason)}});
  }
  return decisions;
}

ordered_json SeriesData(const DriveRecord& record, const loop::Config& config,
                        const config::RouteFile& road) {
  ordered_json series;
  const auto state = [](int index) { return [index](const DriveSample& s) { return s.z[index]; }; };
  series["t"] = Series(record, 2, [&](const DriveSample& s) { return record.Time(s); });
  series["X"] = Series(record, 2, state(control::kX));
  series["Y"] = Series(record, 2, state(control::kY));
  series["psi"] = Series(record, 3, state(control::kPsi));
  series["upsilon"] = Series(record, 2, state(control::kUpsilon));
  const std::vector<double> progress = Progress(record, road.route);
  const auto place = [&](const DriveSample& s) {
    return progress[static_cast<std::size_t>(&s - record.samples.data())];
  };
  series["s"] = Series(record, 1, place);
  series["stop"] = Series(record, 1, [&](const DriveSample& s) {
    const bool stops = s.manoeuvre.stop_distance < bus::ManoeuvreStatus{}.stop_distance;
    return stops ? place(s) + s.manoeuvre.stop_distance : std::nan("");
  });
  series["upsilon_ref"] =
      Series(record, 2, [&](const DriveSample& s) { return road.route.At(place(s)).speed; });
  series["delta"] = Series(record, 4, [](const DriveSample& s) { return s.u[control::kDelta]; });
  series["a"] = Series(record, 3, [](const DriveSample& s) { return s.u[control::kAcceleration]; });
  series["solve_time"] =
      Series(record, 0, IfSolving([](const DriveSample& s) { return s.status.solve_time * 1e6; }));
  series["solved"] = Series(record, 0, IfSolving([](const DriveSample& s) {
                              return s.status.solver_status == bus::SolverStatus::kSolved ? 1.0 : 0.0;
                            }));
  // An NMPC has no scheduling.
  const bool scheduled = !IsNmpc(config.controller);
  const auto if_scheduled = [scheduled](const auto& value) {
    return IfSolving(
        [=](const DriveSample& s) { return scheduled ? static_cast<double>(value(s)) : std::nan(""); });
  };
  series["scheduling_error"] =
      Series(record, 3, if_scheduled([](const DriveSample& s) { return s.health.scheduling_error; }));
  series["active_rows"] =
      Series(record, 0, if_scheduled([](const DriveSample& s) { return s.health.active_rows; }));
  series["largest_slack"] =
      Series(record, 2, if_scheduled([](const DriveSample& s) { return s.health.largest_slack; }));
  return series;
}

ordered_json PlansData(const DriveRecord& record) {
  ordered_json plans{
      {"k", ordered_json::array()}, {"dX", ordered_json::array()}, {"dY", ordered_json::array()}};
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    const DriveSample& sample = record.samples[k];
    if (sample.plan.empty()) continue;
    ordered_json dX = ordered_json::array(), dY = ordered_json::array();
    for (const Eigen::Vector2d& point : sample.plan) {
      dX.push_back(Rounded(point.x() - sample.z[control::kX], 2));
      dY.push_back(Rounded(point.y() - sample.z[control::kY], 2));
    }
    plans["k"].push_back(k);
    plans["dX"].push_back(std::move(dX));
    plans["dY"].push_back(std::move(dY));
  }
  return plans;
}

}  // namespace

ordered_json RoadData(const config::RouteFile& road) {
  constexpr double kSpacing = 2.0;  // [m]
  struct Line {
    ordered_json X = ordered_json::array(), Y = ordered_json::array();
  };
  const auto line = [&](const auto& lateral) {
    Line points;
    const auto steps = static_cast<int>(std::ceil(road.route.length() / kSpacing));
    for (int i = 0; i <= steps; ++i) {
      const double s = std::min(i * kSpacing, road.route.length());
      const Eigen::Vector2d beside = control::Beside(road.route.At(s), lateral(s));
      points.X.push_back(Rounded(beside.x(), 2));
      points.Y.push_back(Rounded(beside.y(), 2));
    }
    return ordered_json{{"X", points.X}, {"Y", points.Y}};
  };
  return {{"reference", line([](double) { return 0.0; })},
          {"left", line([&](double s) { return road.road.At(s).left; })},
          {"right", line([&](double s) { return road.road.At(s).right; })}};
}

ordered_json DriveData(const DriveRecord& record, const DriveLabel& label, const loop::Config& config,
                       const config::RouteFile& road) {
  const control::Input &lo = config.mpc.u_min, &hi = config.mpc.u_max;
  return {{"name", label.name},
          {"controller", loop::ControllerName(config.controller)},
          {"horizon", loop::HorizonOf(config)},
          {"t_s", config.mpc.t_s},
          {"road", label.road_key},
          {"obstacles", ObjectsData(record, loop::ObstacleMarginOf(config), road)},
          {"decisions", DecisionsData(record)},
          {"outline", OutlineData(label.footprint, config.vehicle)},
          {"limits",
           {{"delta", {Rounded(lo[control::kDelta], 4), Rounded(hi[control::kDelta], 4)}},
            {"a", {lo[control::kAcceleration], hi[control::kAcceleration]}}}},
          {"series", SeriesData(record, config, road)},
          {"plans", PlansData(record)}};
}

}  // namespace tools
