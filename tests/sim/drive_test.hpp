// Drives of the virtual vehicle with the stand-in of a controller, to their summary.
#pragma once

#include <string>

#include "gtest/gtest.h"
#include "sim/recorder.hpp"
#include "tests/sim/fake_daemon.hpp"
#include "tests/sim/scenario_files.hpp"

namespace sim {

class DriveTest : public testing::Test {
 protected:
  // Drives to the end; `disturb` may change the controller before each cycle.
  template <typename F>
  Summary Drive(const Scenario& scenario, const F& disturb) {
    VirtualVehicle vehicle(scenario, bus_);
    FakeDaemon controller(bus_, scenario.route);
    Recorder recorder(scenario);
    while (!recorder.finished()) {
      disturb(controller, vehicle);
      for (const can::Frame& frame : vehicle.Sense({})) {
        for (const can::Frame& answer : controller.Receive(frame)) vehicle.Receive(answer);
      }
      recorder.Record(vehicle);
      vehicle.Advance();
    }
    return recorder.Result();
  }
  Summary Drive(const std::string& text) {
    return Drive(files_.Load(text), [](FakeDaemon&, VirtualVehicle&) {});
  }

  ScenarioFiles files_;
  bus::VehicleBus bus_;
};

}  // namespace sim
