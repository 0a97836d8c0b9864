#include "tools/drive/drive_record.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <variant>

#include "dbc/e2e.hpp"
#include "loop/obstacle_assembler.hpp"

namespace tools {
namespace {

template <typename... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <typename... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

}  // namespace

double DriveRecord::Distance(const DriveSample& sample, const control::Obstacle& obstacle) const {
  const double t = Time(sample);
  return std::hypot(sample.z[control::kX] - obstacle.X - t * obstacle.velocity_X,
                    sample.z[control::kY] - obstacle.Y - t * obstacle.velocity_Y);
}

DriveRecord Thinned(const DriveRecord& record) {
  constexpr double kNear = 25.0;  // [m]
  constexpr std::size_t kOneIn = 4;
  DriveRecord thinned{.t_s = record.t_s, .samples = {}, .obstacles = record.obstacles};
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    const DriveSample& sample = record.samples[k];
    const bool near = std::ranges::any_of(record.obstacles, [&](const control::Obstacle& obstacle) {
      return record.Distance(sample, obstacle) < kNear;
    });
    const bus::SolverStatus status = sample.status.solver_status;
    const bool unsolved = status != bus::SolverStatus::kNone && status != bus::SolverStatus::kSolved;
    if (k % kOneIn != 0 && !near && !unsolved) continue;
    thinned.samples.push_back(sample);
    if (!near) thinned.samples.back().plan.clear();
  }
  return thinned;
}

double LargestPlanChange(const DriveRecord& record) {
  double largest = 0.0;
  for (std::size_t k = 1; k < record.samples.size(); ++k) {
    const DriveSample &before = record.samples[k - 1], &after = record.samples[k];
    if (after.cycle != before.cycle + 1) continue;
    for (std::size_t i = 0; i < after.plan.size() && i + 1 < before.plan.size(); ++i) {
      largest = std::max(largest, (after.plan[i] - before.plan[i + 1]).norm());
    }
  }
  return largest;
}

std::size_t SampleOfStep(const DriveRecord& record, int step) {
  const auto solving = [](const DriveSample& s) {
    return s.status.solver_status != bus::SolverStatus::kNone;
  };
  const auto first = std::ranges::find_if(record.samples, solving) - record.samples.begin();
  return std::min(static_cast<std::size_t>(first + step), record.samples.size() - 1);
}

DriveRecord Excerpt(const DriveRecord& record, std::size_t from, std::size_t to) {
  DriveRecord excerpt{.t_s = record.t_s, .samples = {}, .obstacles = record.obstacles};
  for (std::size_t k = from; k <= to && k < record.samples.size(); ++k)
    excerpt.samples.push_back(record.samples[k]);
  return excerpt;
}

void DriveRecorder::Take(const can::Frame& frame) {
  if (frame.kind != can::FrameKind::kData || frame.extended || frame.fd || bus_->Find(frame.id) == nullptr)
    return;
  const bus::E2eCheck check = bus_->Check(frame.id, frame.Payload());
  if (check.verdict != bus::E2eVerdict::kOk) return;
  if (const auto message = bus_->Decode(frame.id, frame.Payload())) {
    TakeMessage(*message, check.counter, frame.timestamp);
  }
}

// Adds a sample once all three messages of a state set have been received, in any order.
void DriveRecorder::AddSampleIfWhole(std::uint8_t counter, can::Time time) {
  if (part_.pose != counter || part_.motion != counter || part_.feedback != counter) return;
  part_ = {};
  std::int64_t cycle = 0;
  if (last_) {
    const int passed = (counter + dbc::kCounterModulus - last_->counter) % dbc::kCounterModulus;
    // Only the time reveals whole turns of the counter. A lock-step run is faster than real time: no turns are counted.
    const double silence = std::chrono::duration<double>(time - last_->time).count() / record_.t_s;
    const auto turns = std::max(0L, std::lround((silence - passed) / dbc::kCounterModulus));
    if (passed == 0 && turns == 0) return;  // repeated
    cycle = record_.samples.back().cycle + passed + turns * dbc::kCounterModulus;
  }
  last_ = {.counter = counter, .time = time};
  DriveSample& sample = record_.samples.emplace_back();
  sample.cycle = cycle;
  sample.z << pose_.X, pose_.Y, motion_.upsilon, motion_.nu, feedback_.psi, motion_.omega;
  sample.u << feedback_.delta, feedback_.acceleration;
  status_received_ = health_received_ = plan_wanted_ = false;
}

// The motion follows the obstacle's position; the velocity allows moving the position back to cycle 0.
void DriveRecorder::TakeMotion(const bus::ObstacleMotion& motion) {
  const int id = motion.object_id;
  const auto obstacle = std::ranges::find(record_.obstacles, id, &control::Obstacle::id);
  if (obstacle == record_.obstacles.end() ||
      std::ranges::find(moving_received_, id) != moving_received_.end())
    return;
  moving_received_.push_back(id);
  // Obstacles are sent before the state set of their cycle.
  const double t = record_.samples.empty() ? 0.0 : record_.Time(record_.samples.back()) + record_.t_s;
  obstacle->velocity_X = motion.velocity_X;
  obstacle->velocity_Y = motion.velocity_Y;
  obstacle->object_class = loop::ToControl(motion.object_class);
  obstacle->X -= t * motion.velocity_X;
  obstacle->Y -= t * motion.velocity_Y;
}

void DriveRecorder::TakeMessage(const bus::Message& message, std::uint8_t counter, can::Time time) {
  DriveSample* const sample = record_.samples.empty() ? nullptr : &record_.samples.back();
  const auto find = [this](int id) {
    return std::ranges::find(record_.obstacles, id, &control::Obstacle::id);
  };
  std::visit(Overloaded{
                 [&](const bus::VehiclePose& pose) {
                   pose_ = pose;
                   part_.pose = counter;
                   AddSampleIfWhole(counter, time);
                 },
                 [&](const bus::VehicleMotion& motion) {
                   motion_ = motion;
                   part_.motion = counter;
                   AddSampleIfWhole(counter, time);
                 },
                 [&](const bus::VehicleFeedback& feedback) {
                   feedback_ = feedback;
                   part_.feedback = counter;
                   AddSampleIfWhole(counter, time);
                 },
                 [&](const bus::ObstaclePosition& position) {
                   if (find(position.object_id) != record_.obstacles.end()) return;
                   record_.obstacles.push_back({.id = position.object_id, .X = position.X, .Y = position.Y});
                 },
                 [&](const bus::ObstacleShape& shape) {
                   const auto obstacle = find(shape.object_id);
                   if (obstacle == record_.obstacles.end()) return;
                   obstacle->r_x = shape.semi_axis_x;
                   obstacle->r_y = shape.semi_axis_y;
                   obstacle->heading = shape.heading;
                   obstacle->shape = loop::ToControl(shape.outline);
                 },
                 [&](const bus::ObstacleMotion& motion) { TakeMotion(motion); },
                 [&](const bus::ControllerStatus& status) {
                   if (sample == nullptr || status_received_) return;
                   sample->status = status;
                   status_received_ = true;
                 },
                 [&](const bus::SchedulingHealth& health) {
                   if (sample == nullptr || health_received_) return;
                   sample->health = health;
                   health_received_ = true;
                 },
                 [&](const bus::HorizonHeader& header) {
                   plan_wanted_ =
                       sample != nullptr && sample->plan.empty() && header.state_counter == last_->counter;
                 },
                 [&](const bus::HorizonPoint& point) {
                   if (plan_wanted_) sample->plan.emplace_back(point.X, point.Y);
                 },
                 [](const auto&) {},
             },
             message);
}

}  // namespace tools
