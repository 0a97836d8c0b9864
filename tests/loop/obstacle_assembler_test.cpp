#include "loop/obstacle_assembler.hpp"

#include <gtest/gtest.h>

namespace loop {
namespace {

using namespace std::chrono_literals;

void Report(ObstacleAssembler& assembler, std::uint8_t id, double X) {
  assembler.Update(bus::ObstaclePosition{.object_id = id, .X = X, .Y = -X});
  assembler.Update(bus::ObstacleShape{.object_id = id,
                                      .semi_axis_x = 2.0,
                                      .semi_axis_y = 1.0,
                                      .heading = 0.3,
                                      .passing_side = bus::PassingSide::kRight,
                                      .outline = bus::Outline::kBox});
  assembler.Update(bus::ObstacleMotion{
      .object_id = id, .velocity_X = 5.0, .velocity_Y = 6.0, .object_class = bus::ObstacleClass::kCycle});
}

TEST(ObstacleAssembler, ListTakesOverAllObjectsSinceTheLastOne) {
  ObstacleAssembler assembler;
  EXPECT_EQ(assembler.Age(1s), base::Time::max());
  Report(assembler, 7, 10.0);
  Report(assembler, 2, 20.0);
  EXPECT_TRUE(assembler.obstacles().empty());
  EXPECT_TRUE(assembler.Update(bus::ObstacleList{.count = 2}, 1s));
  ASSERT_EQ(assembler.obstacles().size(), 2U);
  const control::Obstacle& first = assembler.obstacles()[0];
  EXPECT_EQ(first.id, 7);
  EXPECT_EQ(first.X, 10.0);
  EXPECT_EQ(first.Y, -10.0);
  EXPECT_EQ(first.r_x, 2.0);
  EXPECT_EQ(first.r_y, 1.0);
  EXPECT_EQ(first.heading, 0.3);
  EXPECT_EQ(first.velocity_X, 5.0);
  EXPECT_EQ(first.velocity_Y, 6.0);
  EXPECT_EQ(first.side, control::PassingSide::kRight);
  EXPECT_EQ(first.shape, control::ObstacleShape::kBox);
  EXPECT_EQ(first.object_class, control::ObstacleClass::kCycle);
  EXPECT_EQ(assembler.obstacles()[1].id, 2);

  EXPECT_TRUE(assembler.Update(bus::ObstacleList{.count = 0}, 2s));  // all gone
  EXPECT_TRUE(assembler.obstacles().empty());
  EXPECT_EQ(assembler.Age(3s), 1s);
}

TEST(ObstacleAssembler, ShapeAndClassOfTheBusAreTheControllers) {
  using bus::ObstacleClass;
  using Class = control::ObstacleClass;
  EXPECT_EQ(ToControl(bus::Outline::kEllipse), control::ObstacleShape::kEllipse);
  EXPECT_EQ(ToControl(bus::Outline::kBox), control::ObstacleShape::kBox);
  EXPECT_EQ(ToControl(ObstacleClass::kUnknown), Class::kUnknown);
  EXPECT_EQ(ToControl(ObstacleClass::kStatic), Class::kStatic);
  EXPECT_EQ(ToControl(ObstacleClass::kVehicle), Class::kVehicle);
  EXPECT_EQ(ToControl(ObstacleClass::kCycle), Class::kCycle);
  EXPECT_EQ(ToControl(ObstacleClass::kPedestrian), Class::kPedestrian);
}

TEST(ObstacleAssembler, ListThatDoesNotFitLeavesTheOldObstacles) {
  ObstacleAssembler assembler;
  Report(assembler, 1, 10.0);
  ASSERT_TRUE(assembler.Update(bus::ObstacleList{.count = 1}, 1s));

  Report(assembler, 1, 11.0);
  EXPECT_FALSE(assembler.Update(bus::ObstacleList{.count = 2}, 2s));  // one too few
  Report(assembler, 1, 12.0);
  Report(assembler, 2, 12.0);
  EXPECT_FALSE(assembler.Update(bus::ObstacleList{.count = 1}, 2s));  // one too many
  assembler.Update(bus::ObstaclePosition{.object_id = 1, .X = 13.0});
  EXPECT_FALSE(assembler.Update(bus::ObstacleList{.count = 1}, 2s));  // shape and motion missing
  Report(assembler, 1, 14.0);
  assembler.Update(bus::ObstaclePosition{.object_id = 3});
  EXPECT_FALSE(assembler.Update(bus::ObstacleList{.count = 1}, 2s));  // an incomplete one as well

  ASSERT_EQ(assembler.obstacles().size(), 1U);
  EXPECT_EQ(assembler.obstacles()[0].X, 10.0);
  EXPECT_EQ(assembler.rejected(), 4U);
  EXPECT_EQ(assembler.Age(2s), 1s);

  Report(assembler, 1, 15.0);
  EXPECT_TRUE(assembler.Update(bus::ObstacleList{.count = 1}, 3s));  // nothing is left of the rejected ones
  EXPECT_EQ(assembler.obstacles()[0].X, 15.0);
}

TEST(ObstacleAssembler, ObjectWithoutExtentIsIncomplete) {
  ObstacleAssembler assembler;
  assembler.Update(bus::ObstaclePosition{.object_id = 1});
  assembler.Update(bus::ObstacleShape{.object_id = 1, .semi_axis_x = 0.0, .semi_axis_y = 1.0});
  assembler.Update(bus::ObstacleMotion{.object_id = 1});
  EXPECT_FALSE(assembler.Update(bus::ObstacleList{.count = 1}, 1s));
}

TEST(ObstacleAssembler, HoldsAllObjectsThatAListCanCount) {
  ObstacleAssembler assembler;
  for (std::uint8_t id = 0; id < 64; ++id) Report(assembler, id, id);
  EXPECT_TRUE(assembler.Update(bus::ObstacleList{.count = 64}, 1s));
  ASSERT_EQ(assembler.obstacles().size(), 64U);
  EXPECT_EQ(assembler.obstacles()[63].X, 63.0);
}

TEST(ObstacleAssembler, MoreObjectsThanItHoldsAreRefusedAsAWhole) {
  ObstacleAssembler assembler;
  for (std::size_t i = 0; i <= ObstacleAssembler::kMaxObstacles; ++i) {
    Report(assembler, static_cast<std::uint8_t>(i), 1.0);
  }
  EXPECT_FALSE(assembler.Update(bus::ObstacleList{.count = ObstacleAssembler::kMaxObstacles}, 1s));
  EXPECT_TRUE(assembler.obstacles().empty());
}

}  // namespace
}  // namespace loop
