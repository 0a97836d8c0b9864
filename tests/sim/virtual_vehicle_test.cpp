#include "sim/virtual_vehicle.hpp"

#include <chrono>
#include <fmt/format.h>
#include <map>
#include <utility>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/sim/fake_daemon.hpp"
#include "tests/sim/scenario_files.hpp"

namespace sim {
namespace {

using testing::ElementsAre;

const std::string kTwoObstacles =
    "[[obstacle]]\nid = 1\ns = 50\nr_x = 1\nr_y = 1\nvelocity_X = 2\n[[obstacle]]\nid = 7\ns = 90\nr_x = "
    "1\nr_y = 1\n";

class VirtualVehicleTest : public testing::Test {
 protected:
  std::vector<std::string> NamesOf(std::span<const can::Frame> frames) const {
    std::vector<std::string> names;
    for (const can::Frame& frame : frames) names.push_back(bus_.Find(frame.id)->name);
    return names;
  }
  // One cycle with a controller.
  static void Cycle(VirtualVehicle& vehicle, FakeDaemon& controller) {
    for (const can::Frame& frame : vehicle.Sense({})) {
      for (const can::Frame& answer : controller.Receive(frame)) vehicle.Receive(answer);
    }
    vehicle.Advance();
  }

  ScenarioFiles files_;
  bus::VehicleBus bus_;
};

TEST_F(VirtualVehicleTest, SendsItsFramesInTheOrderOfTheBusContract) {
  VirtualVehicle vehicle(files_.Load(kTwoObstacles), bus_);
  EXPECT_THAT(NamesOf(vehicle.Sense({})),
              ElementsAre("DriverRequest", "ObstacleObject", "ObstacleObject", "ObstacleObject",
                          "ObstacleObject", "ObstacleObject", "ObstacleObject", "ObstacleList", "VehiclePose",
                          "VehicleMotion", "VehicleFeedback"));
}

TEST_F(VirtualVehicleTest, FramesCarryTheTimeTheyAreSensedAt) {
  VirtualVehicle vehicle(files_.Load(""), bus_);
  const can::Time now(std::chrono::seconds(7));
  for (const can::Frame& frame : vehicle.Sense(now)) {
    EXPECT_EQ(frame.timestamp, now);
  }
}

TEST_F(VirtualVehicleTest, EveryMessageHasItsOwnCounterThatGoesUpWithEachFrame) {
  VirtualVehicle vehicle(files_.Load(kTwoObstacles), bus_);
  std::map<std::uint32_t, std::uint8_t> expected;
  for (int cycle = 0; cycle < 40; ++cycle) {
    for (const can::Frame& frame : vehicle.Sense({})) {
      const bus::E2eCheck check = bus_.Check(frame.id, frame.Payload());
      EXPECT_EQ(check.verdict, bus::E2eVerdict::kOk);
      EXPECT_EQ(check.counter, expected[frame.id]);
      expected[frame.id] = dbc::NextCounter(check.counter);
    }
    vehicle.Advance();
  }
}

TEST_F(VirtualVehicleTest, TellsStateAndObstaclesAsTheyAre) {
  const Scenario scenario = files_.Load(kTwoObstacles + "[initial]\nlateral = 0.5\n");
  VirtualVehicle vehicle(scenario, bus_);
  for (int i = 0; i < 20; ++i) vehicle.Advance();
  int positions = 0;
  for (const can::Frame& frame : vehicle.Sense({})) {
    const bus::Message message = bus_.Decode(frame.id, frame.Payload()).value();
    if (const auto* pose = std::get_if<bus::VehiclePose>(&message)) {
      EXPECT_NEAR(pose->X, 10.0 + 12.0, 1e-4);
      EXPECT_NEAR(pose->Y, 0.5, 1e-4);
    } else if (const auto* position = std::get_if<bus::ObstaclePosition>(&message)) {
      EXPECT_EQ(position->object_id, positions == 0 ? 1 : 7);
      if (positions == 0) {
        EXPECT_NEAR(position->X, 60.0 + 2.0, 1e-3);
      }
      ++positions;
    } else if (const auto* list = std::get_if<bus::ObstacleList>(&message)) {
      EXPECT_EQ(list->count, 2);
    }
  }
  EXPECT_EQ(positions, 2);
}

TEST_F(VirtualVehicleTest, TellsGhostsAfterTheObstaclesThatItPerceives) {
  VirtualVehicle vehicle(files_.Load("[[obstacle]]\nid = 1\ns = 50\nr_x = 1\nr_y = 1\n"
                                     "[[obstacle]]\nid = 2\ns = 70\nr_x = 1\nr_y = 1\nappears_at = 5\n"),
                         bus_);
  vehicle.SetGhosts({{.id = 40, .X = 33.0, .Y = -2.0}, {.id = 41, .X = 34.0}});
  std::vector<int> ids;
  int count = -1;
  for (const can::Frame& frame : vehicle.Sense({})) {
    const bus::Message message = bus_.Decode(frame.id, frame.Payload()).value();
    if (const auto* position = std::get_if<bus::ObstaclePosition>(&message)) {
      ids.push_back(position->object_id);
      if (position->object_id == 40) {
        EXPECT_NEAR(position->X, 33.0, 1e-3);
        EXPECT_NEAR(position->Y, -2.0, 1e-3);
      }
    } else if (const auto* list = std::get_if<bus::ObstacleList>(&message)) {
      count = list->count;
    }
  }
  EXPECT_THAT(ids, ElementsAre(1, 40, 41));
  EXPECT_EQ(count, 3);
  ASSERT_EQ(vehicle.PerceivedNow().size(), 1U);
  EXPECT_EQ(vehicle.PerceivedNow().front().id, 1);
  EXPECT_EQ(vehicle.ObstaclesNow().size(), 2U) << "ghosts do not exist";
}

TEST_F(VirtualVehicleTest, TellsShapeAndClassOfEachObstacle) {
  const std::vector<std::pair<std::string, bus::ObstacleClass>> classes{
      {"unknown", bus::ObstacleClass::kUnknown},
      {"static", bus::ObstacleClass::kStatic},
      {"vehicle", bus::ObstacleClass::kVehicle},
      {"cycle", bus::ObstacleClass::kCycle},
      {"pedestrian", bus::ObstacleClass::kPedestrian}};
  std::string text;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    text += fmt::format("[[obstacle]]\nid = {}\ns = 50\nr_x = {}\nr_y = 1\nshape = \"{}\"\nclass = \"{}\"\n",
                        i, 16 + i, i % 2 == 0 ? "box" : "ellipse", classes[i].first);
  }
  VirtualVehicle vehicle(files_.Load(text), bus_);
  std::size_t shapes = 0, motions = 0;
  for (const can::Frame& frame : vehicle.Sense({})) {
    const bus::Message message = bus_.Decode(frame.id, frame.Payload()).value();
    if (const auto* shape = std::get_if<bus::ObstacleShape>(&message)) {
      EXPECT_EQ(shape->outline, shapes % 2 == 0 ? bus::Outline::kBox : bus::Outline::kEllipse);
      EXPECT_NEAR(shape->semi_axis_x, 16.0 + static_cast<double>(shapes), 2e-3);
      ++shapes;
    } else if (const auto* motion = std::get_if<bus::ObstacleMotion>(&message)) {
      EXPECT_EQ(motion->object_class, classes.at(motions).second);
      ++motions;
    }
  }
  EXPECT_EQ(shapes, classes.size());
  EXPECT_EQ(motions, classes.size());
}

TEST_F(VirtualVehicleTest, ObstacleThatAppearsLaterIsThereButNotPerceivedBefore) {
  const Scenario scenario = files_.Load(
      "[[obstacle]]\nid = 1\ns = 50\nr_x = 1\nr_y = 1\nvelocity_X = 2\nappears_at = 0.1\n"
      "[[obstacle]]\nid = 7\ns = 90\nr_x = 1\nr_y = 1\n");
  VirtualVehicle vehicle(scenario, bus_);
  for (int cycle = 0; cycle < 4; ++cycle) {
    const bool appeared = cycle >= 2;  // 0.1 s
    std::vector<int> ids;
    int count = -1;
    for (const can::Frame& frame : vehicle.Sense({})) {
      const bus::Message message = bus_.Decode(frame.id, frame.Payload()).value();
      if (const auto* position = std::get_if<bus::ObstaclePosition>(&message)) {
        ids.push_back(position->object_id);
        if (position->object_id == 1) {
          EXPECT_NEAR(position->X, 60.0 + 0.1 * cycle, 1e-3);
        }
      } else if (const auto* list = std::get_if<bus::ObstacleList>(&message)) {
        count = list->count;
      }
    }
    EXPECT_EQ(ids, appeared ? std::vector<int>({1, 7}) : std::vector<int>({7})) << cycle;
    EXPECT_EQ(count, appeared ? 2 : 1) << cycle;
    EXPECT_EQ(vehicle.ObstaclesNow().size(), 2u);
    vehicle.Advance();
  }
}

TEST_F(VirtualVehicleTest, BeforeEngagementRollsOnAsItStarted) {
  VirtualVehicle vehicle(files_.Load(""), bus_);
  for (int i = 0; i < 40; ++i) vehicle.Advance();
  EXPECT_NEAR(vehicle.time(), 2.0, 1e-9);
  EXPECT_NEAR(vehicle.state()[control::kX], 34.0, 1e-9);
  EXPECT_NEAR(vehicle.state()[control::kUpsilon], 12.0, 1e-9);
}

TEST_F(VirtualVehicleTest, CommandIsObeyedOnlyWhileEnabled) {
  VirtualVehicle vehicle(files_.Load(""), bus_);
  const FakeDaemon controller(bus_, files_.Load("").route);
  vehicle.Receive(controller.Encode(bus::SteeringCommand{.enable = false, .delta = 0.1}));
  vehicle.Receive(controller.Encode(bus::AccelerationCommand{.enable = false, .acceleration = 1.0}));
  vehicle.Advance();
  EXPECT_EQ(vehicle.actuators(), control::Input(0.0, 0.0));
  vehicle.Receive(controller.Encode(bus::SteeringCommand{.enable = true, .delta = 0.1}));
  vehicle.Receive(controller.Encode(bus::AccelerationCommand{.enable = true, .acceleration = 1.0}));
  vehicle.Advance();
  EXPECT_NEAR(vehicle.actuators()[control::kDelta], 0.1, 1e-6);
  EXPECT_NEAR(vehicle.actuators()[control::kAcceleration], 1.0, 1e-4);
}

TEST_F(VirtualVehicleTest, DriverTakesOverAfterDisablingAndBrakesToAStop) {
  VirtualVehicle vehicle(files_.Load(""), bus_);
  const FakeDaemon controller(bus_, files_.Load("").route);
  vehicle.Receive(controller.Encode(bus::SteeringCommand{.enable = true, .delta = 0.02}));
  vehicle.Receive(controller.Encode(bus::AccelerationCommand{.enable = true, .acceleration = 0.0}));
  vehicle.Advance();
  vehicle.Receive(controller.Encode(bus::SteeringCommand{.enable = false, .delta = 0.3}));
  vehicle.Receive(controller.Encode(bus::AccelerationCommand{.enable = false, .acceleration = 2.0}));
  vehicle.Advance();
  EXPECT_NEAR(vehicle.actuators()[control::kDelta], 0.02, 1e-6);
  EXPECT_EQ(vehicle.actuators()[control::kAcceleration], kDriverDeceleration);
  for (int i = 0; i < 200; ++i) vehicle.Advance();
  EXPECT_NEAR(vehicle.state()[control::kUpsilon], 0.0, 1e-6);
}

TEST_F(VirtualVehicleTest, DriverTakesOverAtOnceThoughCommandsTakeTheirTime) {
  const Scenario scenario =
      files_.Load("[initial]\nlateral = 1.0\n[vehicle]\ndelay_cycles = 4\n[driver]\ndisengage_at = 2.0\n");
  VirtualVehicle vehicle(scenario, bus_);
  FakeDaemon controller(bus_, scenario.route);
  while (vehicle.time() < 2.0) Cycle(vehicle, controller);
  ASSERT_EQ(vehicle.mode(), bus::Mode::kActive);
  const double held = vehicle.actuators()[control::kDelta];
  ASSERT_NE(held, 0.0);
  for (int i = 0; i < 30; ++i) {
    Cycle(vehicle, controller);
    EXPECT_EQ(vehicle.actuators()[control::kDelta], held) << "cycle " << i;
    EXPECT_EQ(vehicle.actuators()[control::kAcceleration], kDriverDeceleration) << "cycle " << i;
  }
}

TEST_F(VirtualVehicleTest, CommandThatIsNotRenewedIsObeyedForItsLifetimeOnly) {
  VirtualVehicle vehicle(files_.Load(""), bus_);
  const FakeDaemon controller(bus_, files_.Load("").route);
  vehicle.Receive(controller.Encode(bus::SteeringCommand{.enable = true, .delta = 0.0}));
  vehicle.Receive(controller.Encode(bus::AccelerationCommand{.enable = true, .acceleration = 1.0}));
  for (int i = 0; i < kCommandLifetime; ++i) {
    vehicle.Advance();
    EXPECT_NEAR(vehicle.actuators()[control::kAcceleration], 1.0, 1e-4);
  }
  EXPECT_EQ(vehicle.missed_commands(), static_cast<std::uint64_t>(kCommandLifetime - 1));
  vehicle.Advance();
  EXPECT_EQ(vehicle.actuators()[control::kAcceleration], kDriverDeceleration);
}

TEST_F(VirtualVehicleTest, IsAnsweredByBothCommandsToItsCounterAndAStatusAfterThem) {
  VirtualVehicle vehicle(files_.Load(""), bus_);
  FakeDaemon controller(bus_, files_.Load("").route);
  vehicle.Advance();  // the counter is 1 now
  vehicle.Receive(controller.Encode(bus::SteeringCommand{.state_counter = 1}));
  vehicle.Receive(controller.Status());
  vehicle.Receive(controller.Encode(bus::AccelerationCommand{.state_counter = 0}));
  vehicle.Receive(controller.Status());
  EXPECT_FALSE(vehicle.Answered());
  vehicle.Receive(controller.Encode(bus::AccelerationCommand{.state_counter = 1}));
  EXPECT_FALSE(vehicle.Answered());
  vehicle.Receive(controller.Status());
  EXPECT_TRUE(vehicle.Answered());
  vehicle.Advance();
  EXPECT_FALSE(vehicle.Answered());
}

TEST_F(VirtualVehicleTest, FrameWithWrongCrcChangesNothing) {
  VirtualVehicle vehicle(files_.Load(""), bus_);
  const FakeDaemon controller(bus_, files_.Load("").route);
  can::Frame bad = controller.Encode(bus::SteeringCommand{.enable = true, .delta = 0.1});
  bad.data[5] ^= std::byte{0x10};
  vehicle.Receive(bad);
  vehicle.Receive(controller.Encode(bus::AccelerationCommand{.enable = true, .acceleration = 0.0}));
  vehicle.Advance();
  EXPECT_EQ(vehicle.actuators()[control::kDelta], 0.0);
  EXPECT_EQ(vehicle.rejected_frames(), 1u);
}

TEST_F(VirtualVehicleTest, DriverEngagesOnceTheControllerStandsBy) {
  const Scenario scenario = files_.Load("[driver]\nengage_at = 1.0\n");
  VirtualVehicle vehicle(scenario, bus_);
  FakeDaemon controller(bus_, scenario.route);
  while (vehicle.time() < 0.99) {
    Cycle(vehicle, controller);
    EXPECT_EQ(controller.mode, bus::Mode::kStandby);
  }
  while (vehicle.time() < 1.5) Cycle(vehicle, controller);
  EXPECT_EQ(controller.mode, bus::Mode::kActive);
}

TEST_F(VirtualVehicleTest, DriverOverridesAndKeepsTheWheel) {
  const Scenario scenario = files_.Load("[driver]\nbrake_at = 2.0\n");
  VirtualVehicle vehicle(scenario, bus_);
  FakeDaemon controller(bus_, scenario.route);
  while (vehicle.time() < 1.9) Cycle(vehicle, controller);
  EXPECT_EQ(controller.mode, bus::Mode::kActive);
  while (vehicle.time() < 5.0) Cycle(vehicle, controller);
  EXPECT_EQ(controller.mode, bus::Mode::kStandby);
  EXPECT_LT(vehicle.state()[control::kUpsilon], 7.0);
}

TEST(Driver, AsksAgainWhenTheControllerDidNotEngage) {
  Driver driver({});
  int edges = 0;
  bool before = false;
  for (int i = 0; i < 100; ++i) {
    const bool engage = driver.Request(0.05 * i, bus::Mode::kStandby).engage;
    edges += engage && !before;
    before = engage;
  }
  EXPECT_GE(edges, 3);
}

TEST(Driver, DoesNotAskAControllerThatIsNotReady) {
  Driver driver({});
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(driver.Request(0.05 * i, bus::Mode::kInit).engage);
}

TEST(Driver, HoldsTheRequestWhileDriven) {
  Driver driver({});
  for (int i = 0; i < 10; ++i) (void)driver.Request(0.05 * i, bus::Mode::kStandby);
  for (int i = 10; i < 200; ++i) EXPECT_TRUE(driver.Request(0.05 * i, bus::Mode::kActive).engage);
}

}  // namespace
}  // namespace sim
