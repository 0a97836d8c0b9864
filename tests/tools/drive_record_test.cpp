#include "tools/drive/drive_record.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "tests/bus/bus_frames.hpp"
#include "tools/drive/closed_loop.hpp"

namespace {

using tools::DriveRecord;
using tools::DriveRecorder;

const std::filesystem::path kDemo = LPVMPC_SOURCE_DIR "/scenarios/demo";

// The frames of one drive of the demonstration.
class DriveRecordTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    summary_ = tools::DriveClosedLoop(sim::LoadScenario(kDemo / "scenario.toml"),
                                      loop::LoadConfig(kDemo / "lpvmpcd.toml"),
                                      {.frame = [](const can::Frame& frame) { frames_.push_back(frame); }});
  }
  [[nodiscard]] DriveRecord Record(const std::vector<can::Frame>& frames) const {
    DriveRecorder recorder(bus_, 0.05);
    for (const can::Frame& frame : frames) recorder.Take(frame);
    return recorder.record();
  }
  template <typename Typed>
  [[nodiscard]] bool Is(const can::Frame& frame) const {
    return frame.id == bus_.Info<Typed>().id;
  }

  const bus::VehicleBus bus_;
  inline static std::vector<can::Frame> frames_;
  inline static sim::Summary summary_;
};

TEST_F(DriveRecordTest, EveryStateSetIsASampleWithTheAnswerToIt) {
  const DriveRecord record = Record(frames_);
  ASSERT_GE(record.samples.size(), static_cast<std::size_t>(summary_.steps));
  int solved = 0;
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    const tools::DriveSample& sample = record.samples[k];
    EXPECT_EQ(sample.cycle, static_cast<std::int64_t>(k));
    if (sample.status.solver_status != bus::SolverStatus::kSolved) continue;
    ++solved;
    ASSERT_EQ(sample.plan.size(), 9u) << k;  // N = 8
    // A plan starts at the vehicle; the bus transmits it in millimetres.
    EXPECT_NEAR((sample.plan[0] - sample.z.head<2>()).norm(), 0.0, 2e-3) << k;
  }
  EXPECT_GT(solved, 1000);
}

TEST_F(DriveRecordTest, ObstaclesAreThoseOfTheScenario) {
  const DriveRecord record = Record(frames_);
  const auto obstacles = sim::LoadScenario(kDemo / "scenario.toml").obstacles;
  ASSERT_EQ(record.obstacles.size(), obstacles.size());
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    EXPECT_EQ(record.obstacles[i].id, obstacles[i].id);
    EXPECT_NEAR(record.obstacles[i].X, obstacles[i].X, 1e-3);
    EXPECT_NEAR(record.obstacles[i].Y, obstacles[i].Y, 1e-3);
    EXPECT_NEAR(record.obstacles[i].r_x, obstacles[i].r_x, 2e-3);
    EXPECT_NEAR(record.obstacles[i].r_y, obstacles[i].r_y, 2e-3);
    EXPECT_NEAR(std::remainder(record.obstacles[i].heading - obstacles[i].heading, 2 * M_PI), 0.0, 1e-3);
  }
}

TEST_F(DriveRecordTest, ObstaclesHaveTheirShapeAndClass) {
  DriveRecorder recorder(bus_, 0.05);
  std::uint8_t counter = 0;
  for (const bus::Message& message : std::initializer_list<bus::Message>{
           bus::ObstaclePosition{.object_id = 63},
           bus::ObstacleShape{.object_id = 63, .semi_axis_x = 8.0, .outline = bus::Outline::kBox},
           bus::ObstacleMotion{.object_id = 63, .object_class = bus::ObstacleClass::kVehicle}}) {
    recorder.Take(bus::MakeFrame(bus_, message, counter++));
  }
  ASSERT_EQ(recorder.record().obstacles.size(), 1u);
  EXPECT_EQ(recorder.record().obstacles[0].shape, control::ObstacleShape::kBox);
  EXPECT_EQ(recorder.record().obstacles[0].object_class, control::ObstacleClass::kVehicle);
}

TEST_F(DriveRecordTest, LostStateSetsLeaveAGapInTime) {
  std::vector<can::Frame> frames = frames_;
  int pose = 0;
  std::erase_if(frames, [&](const can::Frame& frame) {
    if (Is<bus::VehiclePose>(frame)) ++pose;
    return Is<bus::VehiclePose>(frame) && pose >= 101 && pose <= 103;
  });
  const DriveRecord whole = Record(frames_), record = Record(frames);
  ASSERT_EQ(record.samples.size() + 3, whole.samples.size());
  EXPECT_EQ(record.samples[99].cycle, 99);
  EXPECT_EQ(record.samples[100].cycle, 103);
  EXPECT_EQ(record.samples[100].z, whole.samples[103].z);
  EXPECT_EQ(record.samples.back().cycle, whole.samples.back().cycle);
}

TEST_F(DriveRecordTest, SilenceLongerThanATurnOfTheCounterIsSeenByTheTime) {
  std::vector<can::Frame> frames = frames_;
  using namespace std::chrono_literals;
  std::erase_if(frames, [](const can::Frame& frame) {
    return frame.timestamp > can::Time(10s) && frame.timestamp < can::Time(15s);
  });
  EXPECT_EQ(Record(frames).samples.back().cycle, Record(frames_).samples.back().cycle);
}

TEST_F(DriveRecordTest, RepeatedStateSetAndStatusOfTheTimerChangeNothing) {
  std::vector<can::Frame> frames;
  for (const can::Frame& frame : frames_) {
    frames.push_back(frame);
    // The whole state set is repeated, followed by a second status.
    if (!Is<bus::ControllerStatus>(frame)) continue;
    for (const std::uint32_t id : {bus_.Info<bus::VehiclePose>().id, bus_.Info<bus::VehicleMotion>().id,
                                   bus_.Info<bus::VehicleFeedback>().id}) {
      const auto last =
          std::find_if(frames.rbegin(), frames.rend(), [&](const auto& f) { return f.id == id; });
      frames.push_back(can::Frame(*last));
    }
    frames.push_back(frame);
  }
  const DriveRecord whole = Record(frames_), record = Record(frames);
  ASSERT_EQ(record.samples.size(), whole.samples.size());
  for (std::size_t k = 0; k < whole.samples.size(); ++k) {
    ASSERT_EQ(record.samples[k].cycle, whole.samples[k].cycle);
    ASSERT_EQ(record.samples[k].status.solve_time, whole.samples[k].status.solve_time);
    ASSERT_EQ(record.samples[k].plan.size(), whole.samples[k].plan.size());
  }
}

TEST_F(DriveRecordTest, OrderOfAStateSetDoesNotMatter) {
  std::vector<can::Frame> frames = frames_;
  for (std::size_t i = 0; i + 2 < frames.size(); ++i) {
    if (!Is<bus::VehiclePose>(frames[i])) continue;
    std::swap(frames[i], frames[i + 2]);  // feedback, motion, pose
    i += 2;
  }
  const DriveRecord whole = Record(frames_), record = Record(frames);
  ASSERT_EQ(record.samples.size(), whole.samples.size());
  EXPECT_EQ(record.samples[700].z, whole.samples[700].z);
  EXPECT_EQ(record.samples[700].plan.size(), 9u);
}

TEST_F(DriveRecordTest, AnswerToAStateThatWasLostIsNobodys) {
  std::vector<can::Frame> frames = frames_;
  int pose = 0;
  std::erase_if(frames, [&](const can::Frame& frame) {
    if (Is<bus::VehiclePose>(frame)) ++pose;
    return Is<bus::VehiclePose>(frame) && pose == 301;
  });
  const DriveRecord record = Record(frames), whole = Record(frames_);
  EXPECT_EQ(record.samples[299].plan, whole.samples[299].plan);
  EXPECT_EQ(record.samples[300].plan, whole.samples[301].plan);
}

TEST_F(DriveRecordTest, PositionOfAMovingObstacleIsMovedBackToTheStart) {
  sim::Scenario scenario = sim::LoadScenario(kDemo / "scenario.toml");
  scenario.obstacles = {
      {.id = 3, .X = 200.0, .Y = 60.0, .r_x = 1.0, .r_y = 1.0, .velocity_X = 2.0, .velocity_Y = -1.0}};
  scenario.duration = 10.0;
  DriveRecorder whole(bus_, 0.05), late(bus_, 0.05);
  (void)tools::DriveClosedLoop(scenario, loop::LoadConfig(kDemo / "lpvmpcd.toml"),
                               {.frame = [&](const can::Frame& frame) {
                                 whole.Take(frame);
                                 const bool lost = frame.timestamp < can::Time(std::chrono::seconds(5));
                                 if (!lost || !Is<bus::ObstaclePosition>(frame)) late.Take(frame);
                               }});
  ASSERT_EQ(whole.record().obstacles.size(), 1u);
  ASSERT_EQ(late.record().obstacles.size(), 1u);
  EXPECT_NEAR(late.record().obstacles[0].X, 200.0, 0.05);
  EXPECT_NEAR(late.record().obstacles[0].Y, 60.0, 0.05);
  const tools::DriveSample& last = whole.record().samples.back();
  const double t = whole.record().Time(last);
  EXPECT_GT(t, 9.0);
  EXPECT_NEAR(whole.record().Distance(last, whole.record().obstacles[0]),
              std::hypot(last.z[control::kX] - 200.0 - 2.0 * t, last.z[control::kY] - 60.0 + t), 0.05);
}

TEST_F(DriveRecordTest, PlanChangeIsTheGreatestDistanceBetweenPlansAtTheSameTime) {
  DriveRecord record;
  for (int k = 0; k < 4; ++k) {
    tools::DriveSample sample;
    sample.cycle = k;
    for (int i = 0; i < 3; ++i) sample.plan.emplace_back(k + i, 0.0);
    record.samples.push_back(sample);
  }
  EXPECT_EQ(tools::LargestPlanChange(record), 0.0);
  record.samples[2].plan[1] = {3.0, 0.7};
  EXPECT_DOUBLE_EQ(tools::LargestPlanChange(record), 0.7);
  record.samples[2].cycle = 7;  // no longer consecutive
  record.samples[3].cycle = 9;
  EXPECT_EQ(tools::LargestPlanChange(record), 0.0);
}

TEST_F(DriveRecordTest, ControlStepsAreCountedFromTheFirstProblem) {
  const DriveRecord record = Record(frames_);
  const std::size_t first = tools::SampleOfStep(record, 0);
  EXPECT_NE(record.samples[first].status.solver_status, bus::SolverStatus::kNone);
  EXPECT_EQ(record.samples[first - 1].status.solver_status, bus::SolverStatus::kNone);
  EXPECT_EQ(tools::SampleOfStep(record, 10), first + 10);
  EXPECT_EQ(tools::SampleOfStep(record, 1'000'000), record.samples.size() - 1);
}

TEST_F(DriveRecordTest, FrameThatFailsItsCheckOrIsOfAnotherSenderIsPassedOver) {
  std::vector<can::Frame> frames = frames_;
  int spoilt = 0;
  for (can::Frame& frame : frames) {
    if (!Is<bus::VehicleMotion>(frame) || spoilt == 50) continue;
    frame.data[7] ^= std::byte{1};
    ++spoilt;
  }
  frames.insert(frames.begin(), can::Frame{.id = 0x7FF, .length = 1});
  EXPECT_EQ(Record(frames).samples.size() + 50, Record(frames_).samples.size());
}

TEST_F(DriveRecordTest, ThinnedKeepsWhatIsNearObstaclesAndWhatWasNotSolved) {
  DriveRecord record = Record(frames_);
  record.samples[333].status.solver_status = bus::SolverStatus::kInfeasible;
  const DriveRecord thinned = tools::Thinned(record);
  EXPECT_LT(thinned.samples.size(), record.samples.size() / 2);
  EXPECT_GT(thinned.samples.size(), record.samples.size() / 4);
  std::size_t next = 0;
  for (const tools::DriveSample& sample : record.samples) {
    double distance = 1e9;
    for (const auto& o : record.obstacles) {
      distance = std::min(distance, std::hypot(sample.z[control::kX] - o.X, sample.z[control::kY] - o.Y));
    }
    if (next < thinned.samples.size() && thinned.samples[next].cycle == sample.cycle) {
      EXPECT_EQ(thinned.samples[next].z, sample.z);
      ++next;
    } else {
      EXPECT_GT(distance, 20.0);
      EXPECT_NE(sample.status.solver_status, bus::SolverStatus::kInfeasible);
    }
  }
  EXPECT_EQ(next, thinned.samples.size());
}

TEST_F(DriveRecordTest, ExcerptHoldsTheSamplesAskedForAsFarAsThereAre) {
  const DriveRecord record = Record(frames_);
  const DriveRecord excerpt = tools::Excerpt(record, 100, 110);
  ASSERT_EQ(excerpt.samples.size(), 11u);
  EXPECT_EQ(excerpt.samples[0].cycle, 100);
  EXPECT_EQ(excerpt.obstacles.size(), record.obstacles.size());
  EXPECT_EQ(tools::Excerpt(record, record.samples.size() - 2, record.samples.size() + 50).samples.size(), 2u);
}

}  // namespace
