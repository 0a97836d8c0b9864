// All that a configuration describes, put together: bus, route, controller and the control loop about them.
#pragma once

#include <functional>
#include <memory>

#include "config/route_file.hpp"
#include "control/controller.hpp"
#include "control/course.hpp"
#include "control/plan_check.hpp"
#include "control/reference.hpp"
#include "daemon/config.hpp"
#include "daemon/control_loop.hpp"
#include "daemon/time.hpp"
#include "dbc/vehicle_bus.hpp"

namespace lpvmpcd {

// The bus of the configuration's DBC file, or the one built in. Throws as Assembly does.
[[nodiscard]] dbc::VehicleBus OpenBus(const Config& config);

// Makes the controller that a configuration names. `course` outlives it.
using ControllerMaker =
    std::function<std::unique_ptr<control::Controller>(const Config&, const control::Course& course)>;

// Of those that a daemon drives by. Throws std::runtime_error if it is none of them.
[[nodiscard]] std::unique_ptr<control::Controller> MakeController(const Config& config,
                                                                  const control::Course& course);

class Assembly {
 public:
  // Throws std::runtime_error, one line: a file of the configuration is missing or wrong
  // (config::ConfigError, dbc::DbcError with file and line), the route is shorter than a horizon, or the controller
  // is none for a daemon.
  Assembly(const Config& config, std::function<Time()> stopwatch);
  // With a route and a maker of the caller's; the controller's horizon must be the configuration's.
  Assembly(const Config& config, const config::RouteFile& route, std::function<Time()> stopwatch,
           const ControllerMaker& make);

  Assembly(const Assembly&) = delete;  // the loop points into it
  Assembly& operator=(const Assembly&) = delete;

  [[nodiscard]] ControlLoop& loop() { return loop_; }
  [[nodiscard]] const dbc::VehicleBus& bus() const { return bus_; }
  [[nodiscard]] const control::Reference& reference() const { return reference_; }
  [[nodiscard]] const control::RoadBounds& road() const { return road_; }

 private:
  dbc::VehicleBus bus_;
  control::Reference reference_;
  control::RoadBounds road_;
  control::Course course_;
  std::unique_ptr<control::Controller> controller_;
  control::PlanCheck check_;
  ControlLoop loop_;
};

}  // namespace lpvmpcd
