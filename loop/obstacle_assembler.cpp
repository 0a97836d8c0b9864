#include "loop/obstacle_assembler.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace loop {
namespace {

constexpr unsigned kPosition = 1;
constexpr unsigned kShape = 2;
constexpr unsigned kMotion = 4;
constexpr unsigned kAll = 7;

control::PassingSide ToControl(bus::PassingSide side) {
  switch (side) {
    case bus::PassingSide::kLeft:
      return control::PassingSide::kLeft;
    case bus::PassingSide::kRight:
      return control::PassingSide::kRight;
    case bus::PassingSide::kUnknown:
      break;
  }
  return control::PassingSide::kUnknown;
}

}  // namespace

control::ObstacleShape ToControl(bus::Outline outline) {
  return outline == bus::Outline::kBox ? control::ObstacleShape::kBox : control::ObstacleShape::kEllipse;
}

control::ObstacleClass ToControl(bus::ObstacleClass object_class) {
  switch (object_class) {
    case bus::ObstacleClass::kStatic:
      return control::ObstacleClass::kStatic;
    case bus::ObstacleClass::kVehicle:
      return control::ObstacleClass::kVehicle;
    case bus::ObstacleClass::kCycle:
      return control::ObstacleClass::kCycle;
    case bus::ObstacleClass::kPedestrian:
      return control::ObstacleClass::kPedestrian;
    case bus::ObstacleClass::kUnknown:
      break;
  }
  return control::ObstacleClass::kUnknown;
}

ObstacleAssembler::ObstacleAssembler() {
  pending_.reserve(kMaxObstacles);
  committed_.reserve(kMaxObstacles);
}

void ObstacleAssembler::Update(const bus::ObstaclePosition& position) {
  if (!std::isfinite(position.X) || !std::isfinite(position.Y)) {
    return;
  }
  if (control::Obstacle* obstacle = Part(position.object_id, kPosition)) {
    obstacle->X = position.X;
    obstacle->Y = position.Y;
  }
}

void ObstacleAssembler::Update(const bus::ObstacleShape& shape) {
  const bool extended = shape.semi_axis_x > 0.0 && shape.semi_axis_y > 0.0 &&
                        std::isfinite(shape.semi_axis_x) && std::isfinite(shape.semi_axis_y) &&
                        std::isfinite(shape.heading);
  if (!extended) {
    return;
  }
  if (control::Obstacle* obstacle = Part(shape.object_id, kShape)) {
    obstacle->r_x = shape.semi_axis_x;
    obstacle->r_y = shape.semi_axis_y;
    obstacle->heading = shape.heading;
    obstacle->side = ToControl(shape.passing_side);
    obstacle->shape = ToControl(shape.outline);
  }
}

void ObstacleAssembler::Update(const bus::ObstacleMotion& motion) {
  if (!std::isfinite(motion.velocity_X) || !std::isfinite(motion.velocity_Y)) {
    return;
  }
  if (control::Obstacle* obstacle = Part(motion.object_id, kMotion)) {
    obstacle->velocity_X = motion.velocity_X;
    obstacle->velocity_Y = motion.velocity_Y;
    obstacle->object_class = ToControl(motion.object_class);
  }
}

bool ObstacleAssembler::Update(const bus::ObstacleList& list, base::Time time) {
  const bool whole = !overflow_ && pending_.size() == list.count &&
                     std::ranges::all_of(pending_, [](const Pending& p) { return p.parts == kAll; });
  if (whole) {
    committed_.clear();
    for (const Pending& pending : pending_) {
      committed_.push_back(pending.obstacle);
    }
    known_ = true;
    last_ = time;
  } else {
    ++rejected_;
  }
  pending_.clear();
  overflow_ = false;
  return whole;
}

control::Obstacle* ObstacleAssembler::Part(std::uint8_t id, unsigned part) {
  auto found = std::ranges::find_if(pending_, [id](const Pending& p) { return p.obstacle.id == id; });
  if (found == pending_.end()) {
    if (pending_.size() == kMaxObstacles) {
      overflow_ = true;
      return nullptr;
    }
    pending_.push_back({});
    found = std::prev(pending_.end());
    found->obstacle.id = id;
  }
  found->parts |= part;
  return &found->obstacle;
}

}  // namespace loop
