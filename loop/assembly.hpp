// Builds what a configuration describes: bus, route, controller and the control loop around them.
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

// The bus of the configuration's DBC file, or the built-in one. Throws like Assembly.
[[nodiscard]] bus::VehicleBus OpenBus(const Config& config);

// The route as the controllers need it.
struct Road {
  const control::TimeReference& reference;  // used by the paper's controllers
  const control::RoadProfile& profile;      // used by the others
};

// Makes the controller that a configuration selects. The objects behind `road` outlive it.
using ControllerMaker = std::function<std::unique_ptr<control::Controller>(const Config&, const Road& road)>;

// Makes one of the daemon's controllers. Throws std::runtime_error for an NMPC.
[[nodiscard]] std::unique_ptr<control::Controller> MakeController(const Config& config, const Road& road);

class Assembly {
 public:
  // Throws std::runtime_error with a one-line text if a file of the configuration is missing or wrong
  // (config::ConfigError, dbc::DbcError with file and line), if the route is not longer than the horizon, or if the
  // controller is an NMPC.
  Assembly(const Config& config, std::function<base::Time()> stopwatch);
  // Takes route and maker from the caller; the controller's horizon must be that of the configuration.
  Assembly(const Config& config, const config::RouteFile& route, std::function<base::Time()> stopwatch,
           const ControllerMaker& make);

  Assembly(const Assembly&) = delete;  // the loop points into this object
  Assembly& operator=(const Assembly&) = delete;

  [[nodiscard]] ControlLoop& loop() { return loop_; }
  [[nodiscard]] const bus::VehicleBus& bus() const { return bus_; }
  [[nodiscard]] const control::TimeReference& reference() const { return reference_; }

 private:
  bus::VehicleBus bus_;
  control::TimeReference reference_;
  control::RoadProfile profile_;
  std::unique_ptr<control::Controller> controller_;
  control::PlanCheck check_;
  ControlLoop loop_;
};

}  // namespace loop
