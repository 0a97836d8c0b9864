// All that a configuration describes, put together: bus, route, controller and the control loop about them.
#pragma once

#include <functional>
#include <memory>

#include "base/time.hpp"
#include "bus/vehicle_bus.hpp"
#include "config/route_file.hpp"
#include "control/mpc/controller.hpp"
#include "control/mpc/plan_check.hpp"
#include "control/road/road_profile.hpp"
#include "control/road/time_reference.hpp"
#include "loop/config.hpp"
#include "loop/control_loop.hpp"

namespace loop {

// The bus of the configuration's DBC file, or the one built in. Throws as Assembly does.
[[nodiscard]] bus::VehicleBus OpenBus(const Config& config);

// The route as the controllers need it.
struct Road {
  const control::TimeReference& by_time;    // of the paper's
  const control::RoadProfile& by_progress;  // of the others
};

// Makes the controller that a configuration names. What `road` refers to outlives it.
using ControllerMaker = std::function<std::unique_ptr<control::Controller>(const Config&, const Road& road)>;

// Of those that a daemon drives by. Throws std::runtime_error if it is none of them.
[[nodiscard]] std::unique_ptr<control::Controller> MakeController(const Config& config, const Road& road);

class Assembly {
 public:
  // Throws std::runtime_error, one line: a file of the configuration is missing or wrong
  // (config::ConfigError, dbc::DbcError with file and line), the route is shorter than a horizon, or the controller
  // is none for a daemon.
  Assembly(const Config& config, std::function<base::Time()> stopwatch);
  // With a route and a maker of the caller's; the controller's horizon must be the configuration's.
  Assembly(const Config& config, const config::RouteFile& route, std::function<base::Time()> stopwatch,
           const ControllerMaker& make);

  Assembly(const Assembly&) = delete;  // the loop points into it
  Assembly& operator=(const Assembly&) = delete;

  [[nodiscard]] ControlLoop& loop() { return loop_; }
  [[nodiscard]] const bus::VehicleBus& bus() const { return bus_; }
  [[nodiscard]] const control::TimeReference& reference() const { return reference_; }
  [[nodiscard]] const control::RoadBounds& road() const { return road_; }

 private:
  bus::VehicleBus bus_;
  control::TimeReference reference_;
  control::RoadBounds road_;
  control::RoadProfile profile_;
  std::unique_ptr<control::Controller> controller_;
  control::PlanCheck check_;
  ControlLoop loop_;
};

}  // namespace loop
