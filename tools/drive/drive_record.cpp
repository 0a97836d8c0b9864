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

bool Unsolved(const DriveSample& sample) {
  const bus::SolverStatus status = sample.status.solver_status;
  return status != bus::SolverStatus::kNone && status != bus::SolverStatus::kSolved;
}

// The record without its samples.
DriveRecord WithoutSamples(const DriveRecord& record) {
  return {.t_s = record.t_s, .samples = {}, .objects = record.objects, .decisions = record.decisions};
}

}  // namespace

const RecordedObject::Place& RecordedObject::At(std::int64_t cycle) const {
  const auto later = std::ranges::upper_bound(places, cycle, {}, &Place::cycle);
  return later == places.begin() ? places.front() : *(later - 1);
}

double Distance(const DriveSample& sample, const RecordedObject& object) {
  const RecordedObject::Place& place = object.At(sample.cycle);
  return std::hypot(sample.z[control::kX] - place.X, sample.z[control::kY] - place.Y);
}

DriveRecord Thinned(const DriveRecord& record) {
  constexpr double kNear = 25.0;  // [m]
  constexpr std::size_t kOneIn = 4;
  DriveRecord thinned = WithoutSamples(record);
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    const DriveSample& sample = record.samples[k];
    const bool near = std::ranges::any_of(record.objects, [&](const RecordedObject& object) {
      return object.ExistsAt(sample.cycle) && Distance(sample, object) < kNear;
    });
    if (k % kOneIn != 0 && !near && !Unsolved(sample)) continue;
    thinned.samples.push_back(sample);
    if (!near) thinned.samples.back().plan.clear();
  }
  return thinned;
}

DriveRecord Coarse(const DriveRecord& record, std::size_t one_in) {
  constexpr std::size_t kPlanOneIn = 4;
  DriveRecord coarse = WithoutSamples(record);
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    if (k % one_in != 0 && !Unsolved(record.samples[k])) continue;
    coarse.samples.push_back(record.samples[k]);
    if (coarse.samples.size() % kPlanOneIn != 1) coarse.samples.back().plan.clear();
  }
  return coarse;
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
  DriveRecord excerpt = WithoutSamples(record);
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
  PlaceObjects(cycle);
  status_received_ = health_received_ = manoeuvre_received_ = plan_wanted_ = false;
}

control::Obstacle& DriveRecorder::Reported(int id) {
  const auto reported = std::ranges::find(reported_, id, &control::Obstacle::id);
  if (reported != reported_.end()) return *reported;
  const auto known =
      std::ranges::find(record_.objects, id, [](const RecordedObject& object) { return object.first.id; });
  return reported_.emplace_back(known != record_.objects.end() ? known->first : control::Obstacle{.id = id});
}

// Objects are reported before the state set of their cycle.
void DriveRecorder::PlaceObjects(std::int64_t cycle) {
  for (const control::Obstacle& reported : reported_) {
    auto object = std::ranges::find(record_.objects, reported.id,
                                    [](const RecordedObject& known) { return known.first.id; });
    if (object == record_.objects.end()) {
      record_.objects.push_back({.first = reported, .places = {}});
      object = record_.objects.end() - 1;
    }
    object->places.push_back({.cycle = cycle, .X = reported.X, .Y = reported.Y, .heading = reported.heading});
  }
  reported_.clear();
}

void DriveRecorder::TakeManoeuvre(const bus::ManoeuvreStatus& manoeuvre, DriveSample& sample) {
  if (manoeuvre_received_) return;
  manoeuvre_received_ = true;
  sample.manoeuvre = manoeuvre;
  if (!bus::Drives(sample.status.mode)) {
    decision_.Reset();
  } else if (decision_.Take(manoeuvre)) {
    record_.decisions.push_back({.cycle = sample.cycle - decision_.held() + 1, .manoeuvre = manoeuvre});
  }
}

void DriveRecorder::TakeMessage(const bus::Message& message, std::uint8_t counter, can::Time time) {
  DriveSample* const sample = record_.samples.empty() ? nullptr : &record_.samples.back();
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
                   control::Obstacle& object = Reported(position.object_id);
                   object.X = position.X;
                   object.Y = position.Y;
                 },
                 [&](const bus::ObstacleShape& shape) {
                   control::Obstacle& object = Reported(shape.object_id);
                   object.r_x = shape.semi_axis_x;
                   object.r_y = shape.semi_axis_y;
                   object.heading = shape.heading;
                   object.shape = loop::ToControl(shape.outline);
                 },
                 [&](const bus::ObstacleMotion& motion) {
                   control::Obstacle& object = Reported(motion.object_id);
                   object.velocity_X = motion.velocity_X;
                   object.velocity_Y = motion.velocity_Y;
                   object.object_class = loop::ToControl(motion.object_class);
                 },
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
                 [&](const bus::ManoeuvreStatus& manoeuvre) {
                   if (sample != nullptr) TakeManoeuvre(manoeuvre, *sample);
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
