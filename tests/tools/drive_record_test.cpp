#include "tools/drive/drive_record.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

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
  ASSERT_EQ(record.objects.size(), obstacles.size());
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    EXPECT_EQ(record.objects[i].first.id, obstacles[i].id);
    EXPECT_NEAR(record.objects[i].first.X, obstacles[i].X, 1e-3);
    EXPECT_NEAR(record.objects[i].first.Y, obstacles[i].Y, 1e-3);
    EXPECT_NEAR(record.objects[i].first.r_x, obstacles[i].r_x, 2e-3);
    EXPECT_NEAR(record.objects[i].first.r_y, obstacles[i].r_y, 2e-3);
    EXPECT_NEAR(std::remainder(record.objects[i].first.heading - obstacles[i].heading, 2 * M_PI), 0.0, 1e-3);
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
  bus::FakeVehicle vehicle(bus_);
  for (const can::Frame& frame : vehicle.State()) recorder.Take(frame);
  ASSERT_EQ(recorder.record().objects.size(), 1u);
  EXPECT_EQ(recorder.record().objects[0].first.shape, control::ObstacleShape::kBox);
  EXPECT_EQ(recorder.record().objects[0].first.object_class, control::ObstacleClass::kVehicle);
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

TEST_F(DriveRecordTest, ObjectIsWhereItWasReportedHoweverItMoved) {
  // It sets off on the route, brakes again and disappears.
  sim::Scenario scenario = sim::LoadScenario(kDemo / "scenario.toml");
  scenario.obstacles = {{.id = 3, .r_x = 1.0, .r_y = 1.0}};
  scenario.motions[3] = {.s = 100.0, .speed = {{.time = 1.0}, {.time = 3.0, .speed = 10.0}, {.time = 6.0}}};
  scenario.disappears_at[3] = 8.0;
  scenario.duration = 10.0;
  DriveRecorder recorder(bus_, 0.05);
  std::vector<Eigen::Vector2d> told;
  (void)tools::DriveClosedLoop(scenario, loop::LoadConfig(kDemo / "lpvmpcd.toml"),
                               {.frame = [&](const can::Frame& frame) {
                                 recorder.Take(frame);
                                 if (!Is<bus::ObstaclePosition>(frame)) return;
                                 const auto message = bus_.Decode(frame.id, frame.Payload());
                                 if (const auto* at = std::get_if<bus::ObstaclePosition>(&*message))
                                   told.emplace_back(at->X, at->Y);
                               }});
  const DriveRecord& record = recorder.record();
  ASSERT_EQ(record.objects.size(), 1u);
  const tools::RecordedObject& object = record.objects[0];
  ASSERT_EQ(object.places.size(), told.size());
  for (std::size_t k = 0; k < told.size(); ++k) {
    EXPECT_EQ(object.places[k].X, told[k].x());
    EXPECT_EQ(object.At(static_cast<std::int64_t>(k)).Y, told[k].y());
  }
  const auto last = static_cast<std::int64_t>(told.size()) - 1;
  EXPECT_NEAR(record.Time(last), 8.0, 0.1);
  EXPECT_NEAR((told[100] - told[0]).norm(), 23.3, 1.0) << "10 m up to 3 s, then 13.3 m; the route bends";
  EXPECT_EQ(told[130], told[150]) << "it stands";
  EXPECT_TRUE(object.ExistsAt(last));
  EXPECT_FALSE(object.ExistsAt(last + 1));
  const tools::DriveSample& sample = record.samples[100];
  EXPECT_NEAR(tools::Distance(sample, object),
              std::hypot(sample.z[control::kX] - told[100].x(), sample.z[control::kY] - told[100].y()), 1e-9);
}

TEST_F(DriveRecordTest, DecisionsAreKeptEachWhereItWasTaken) {
  loop::Config config = loop::LoadConfig(kDemo / "lpvmpcd.toml");
  loop::SelectController(config, "lpv-affine");
  DriveRecorder recorder(bus_, 0.05);
  (void)tools::DriveClosedLoop(sim::LoadScenario(kDemo / "scenario.toml"), config,
                               {.frame = [&](const can::Frame& frame) { recorder.Take(frame); }});
  const DriveRecord& record = recorder.record();
  using bus::ManoeuvreDecision;
  ASSERT_FALSE(record.decisions.empty());
  EXPECT_EQ(record.decisions[0].manoeuvre.decision, ManoeuvreDecision::kDrive);
  std::set<int> passed;
  for (std::size_t i = 0; i < record.decisions.size(); ++i) {
    const auto& [cycle, manoeuvre] = record.decisions[i];
    EXPECT_EQ(record.samples[static_cast<std::size_t>(cycle)].manoeuvre.object_id, manoeuvre.object_id);
    if (i > 0) {
      EXPECT_GT(cycle, record.decisions[i - 1].cycle);
    }
    if (manoeuvre.decision == ManoeuvreDecision::kPass) passed.insert(manoeuvre.object_id);
  }
  EXPECT_EQ(passed.size(), record.objects.size()) << "each of them is passed";
  EXPECT_TRUE(Record(frames_).decisions.empty()) << "lpv makes none";
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
    for (const auto& object : record.objects) distance = std::min(distance, tools::Distance(sample, object));
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

TEST_F(DriveRecordTest, CoarseKeepsOneInSoManyAndWhatWasNotSolved) {
  DriveRecord record = Record(frames_);
  record.samples[333].status.solver_status = bus::SolverStatus::kInfeasible;
  const DriveRecord coarse = tools::Coarse(record, 10);
  EXPECT_EQ(coarse.samples.size(), (record.samples.size() + 9) / 10 + 1);
  EXPECT_EQ(coarse.objects.size(), record.objects.size());
  std::size_t plans = 0, kept = 0;
  for (const tools::DriveSample& sample : coarse.samples) {
    EXPECT_TRUE(sample.cycle % 10 == 0 || sample.cycle == 333);
    if (record.samples[static_cast<std::size_t>(sample.cycle)].plan.empty()) continue;
    ++plans;
    if (!sample.plan.empty()) ++kept;
  }
  EXPECT_NEAR(static_cast<double>(kept), static_cast<double>(plans) / 4.0, 1.0);
}

TEST_F(DriveRecordTest, ExcerptHoldsTheSamplesAskedForAsFarAsThereAre) {
  const DriveRecord record = Record(frames_);
  const DriveRecord excerpt = tools::Excerpt(record, 100, 110);
  ASSERT_EQ(excerpt.samples.size(), 11u);
  EXPECT_EQ(excerpt.samples[0].cycle, 100);
  EXPECT_EQ(excerpt.objects.size(), record.objects.size());
  EXPECT_EQ(tools::Excerpt(record, record.samples.size() - 2, record.samples.size() + 50).samples.size(), 2u);
}

}  // namespace
