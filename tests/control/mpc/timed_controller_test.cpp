#include "control/mpc/timed_controller.hpp"

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "gtest/gtest.h"
#include "tests/control/mpc/closed_loop.hpp"
#include "tests/control/narrowing.hpp"

namespace control {
namespace {

constexpr int kHorizon = 10;

// Copies the edges that it is given.
class RoadRecorder final : public TrackingController {
 public:
  explicit RoadRecorder(std::vector<RoadBounds>& road) : road_(&road) {}
  [[nodiscard]] int horizon() const override { return kHorizon; }
  [[nodiscard]] const Plan& Step(const TrackingInput& input) override {
    road_->assign(input.road.begin(), input.road.end());
    return plan_;
  }
  void Reset() override {}

 private:
  std::vector<RoadBounds>* road_;
  Plan plan_;
};

TEST(TimedController, EachStepHasTheEdgesBesideItsSampleOfTheReference) {
  const TimeReference reference = testing::StraightPath(100, 12.0);  // 0.6 m per sample
  std::vector<RoadBounds> road;
  TimedController controller(std::make_unique<RoadRecorder>(road), reference,
                             testing::NarrowingOnTheRight(15.0, 25.0, -1.0));
  const auto step = [&](int due) {
    static_cast<void>(controller.Step({.place = {.due = due, .samples = 100}, .obstacles = {}}));
  };
  step(22);
  ASSERT_EQ(road.size(), static_cast<std::size_t>(kHorizon) + 1);
  for (std::size_t i = 0; i < road.size(); ++i) {
    const double s = 0.6 * static_cast<double>(22 + i);
    EXPECT_NEAR(road[i].right, -4.0 + 0.3 * std::max(s - 15.0, 0.0), 1e-9) << i;
    EXPECT_EQ(road[i].left, 4.0) << i;
  }
  step(98);  // the window reaches beyond the reference's end
  EXPECT_EQ(road.back().right, -1.0);
}

}  // namespace
}  // namespace control
