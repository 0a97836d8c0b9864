#include "tools/scenarios/traffic_objects.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <vector>

#include "control/road/projection.hpp"
#include "control/vehicle/geometry.hpp"

namespace tools {
namespace {

using control::Obstacle;
using control::ObstacleClass;
using control::ObstacleShape;

constexpr double kFirstMeeting = 3.0;  // [s]
constexpr double kLongest = 60.0;      // a drive [s]
constexpr double kLatestNotice = 1.0;  // an object is perceived at least this long before it is met [s]
constexpr double kSlowing = 3.0;       // deceleration that a gap at the start leaves time for [m/s²]
constexpr double kPassingRoom = 0.9;   // beside our vehicle and one that comes [m]
constexpr double kGolden = 0.6180339887498949, kPlastic = 0.7548776662466927;  // of evenly spread sequences

double Fraction(double value) {
  return value - std::floor(value);
}

// A car, lorry, cycle or something of unknown class on the road, about the origin.
Obstacle DrawBody(PointReader& reader) {
  const double which = reader.Uniform(0.0, 1.0), size = reader.Uniform(0.0, 1.0);
  const bool unknown = reader.Chance(0.1);
  Obstacle body{.object_class = ObstacleClass::kVehicle};
  if (which < 0.6) {
    body.r_x = std::lerp(1.8, 2.5, size);
    body.r_y = std::lerp(0.8, 1.0, size);
    body.shape = ObstacleShape::kBox;
  } else if (which < 0.8) {
    body.r_x = std::lerp(3.0, 9.0, size);
    body.r_y = 1.25;
    body.shape = ObstacleShape::kBox;
  } else {
    body.r_x = std::lerp(0.8, 1.0, size);
    body.r_y = 0.35;
    body.object_class = ObstacleClass::kCycle;
  }
  if (unknown) body.object_class = ObstacleClass::kUnknown;
  return body;
}

const char* WhatIs(const Obstacle& body) {
  if (body.shape == ObstacleShape::kEllipse) return body.r_x < 0.5 ? "pedestrian" : "cycle";
  return body.r_x > 2.6 ? "lorry" : "car";
}

// Adds the object, which is met at time `met`, and makes it be perceived `notice` [s] before.
Obstacle& Add(Obstacle object, double met, double notice, sim::Scenario& scenario) {
  object.id = static_cast<int>(scenario.obstacles.size());
  const double appears = met - std::max(notice, kLatestNotice);
  if (appears > 0.0) scenario.appears_at[object.id] = appears;
  scenario.obstacles.push_back(object);
  return scenario.obstacles.back();
}

// Adds one that moves along the route.
void AddMoving(Obstacle body, const sim::RouteMotion& motion, double met, double notice,
               sim::Scenario& scenario) {
  body = sim::OnRoute(body, scenario.route, motion.heading, sim::StateAt(motion, 0.0));
  scenario.motions[Add(body, met, notice, scenario).id] = motion;
}

// Adds one that stands beside the route.
void AddStanding(Obstacle body, double s, double lateral, double heading, double met, double notice,
                 sim::Scenario& scenario) {
  const control::RoutePoint point = scenario.route.At(s);
  const Eigen::Vector2d centre = control::Beside(point, lateral);
  body.X = centre.x();
  body.Y = centre.y();
  body.heading = control::WrapAngle(point.psi + heading);
  Add(body, met, notice, scenario);
}

double DrawMeeting(PointReader& reader, const sim::Scenario& scenario) {
  return reader.Uniform(kFirstMeeting, scenario.route.duration() - 1.0);
}

// Two of three are perceived at least 4 s before they are met.
double DrawNotice(PointReader& reader) {
  const double share = reader.Uniform(0.0, 1.0);
  return share < 1.0 / 3.0 ? std::lerp(kLatestNotice, 4.0, 3.0 * share) : 4.0 + 12.0 * (share - 1.0 / 3.0);
}

std::string Noticed(double notice) {
  return notice < 4.0 ? fmt::format(" seen {:.1f} s before", notice) : "";
}

// The time at which a vehicle at `speed` has caught up with one that is `gap` ahead [s]; 0 if it never does.
double TimeToCatch(const sim::RouteMotion& motion, double speed, double gap) {
  double time = 0.0;
  while (time < kLongest && speed * time < gap + sim::StateAt(motion, time).s - motion.s) time += 0.1;
  return time < kLongest ? time : 0.0;
}

// The narrowest distances from the path to the edges, over the whole road.
control::RoadBounds Narrowest(const sim::Scenario& scenario) {
  control::RoadBounds least{.left = 1e9, .right = -1e9};
  for (double s = 0.0; s <= scenario.route.length(); s += 1.0) {
    const control::RoadBounds bounds = scenario.road.At(s);
    least.left = std::min(least.left, bounds.left);
    least.right = std::max(least.right, bounds.right);
  }
  return least;
}

}  // namespace

std::string AddFollower(PointReader reader, sim::Scenario& scenario) {
  const bool present = reader.Chance(0.35);
  const Obstacle body = DrawBody(reader);
  const double target = scenario.route.At(0.0).speed, speed = reader.Uniform(0.6, 1.5) * target;
  const double faster = std::max(speed - scenario.initial[control::kUpsilon], 0.0);
  const double gap = reader.Uniform(6.0, 45.0) + faster * faster / (2.0 * kSlowing);
  const double lateral = reader.Uniform(-0.4, 0.4);
  if (!present) return "";
  AddMoving(body,
            {.s = -scenario.footprint.rear - gap - body.r_x,
             .speed = {{.time = 0.0, .speed = speed}},
             .lateral = {{.time = 0.0, .lateral = lateral}},
             .follows = true},
            0.0, kLatestNotice, scenario);
  return fmt::format("{} that follows at {:.1f} m/s {:.0f} m behind", WhatIs(body), speed, gap);
}

std::string AddLeader(PointReader reader, sim::Scenario& scenario) {
  const bool present = reader.Chance(0.4);
  const Obstacle body = DrawBody(reader);
  const double target = scenario.route.At(0.0).speed, share = reader.Uniform(0.0, 1.1);
  const double speed = share * target;
  const double slower = std::max(target - speed, 0.0);
  const double gap = reader.Uniform(1.0, 5.0) * target + slower * slower / (2.0 * kSlowing);
  const double lateral = reader.Uniform(-0.4, 0.4);
  const bool brakes = reader.Chance(0.5);
  const double when = reader.Uniform(1.0, 10.0), deceleration = reader.Uniform(2.0, 6.0);
  const double slow = std::max(0.0, reader.Uniform(-0.5, 0.8)) * speed, pause = reader.Uniform(1.0, 16.0);
  const double notice = DrawNotice(reader);
  if (!present) return "";
  sim::RouteMotion motion{.s = scenario.footprint.front + gap + body.r_x,
                          .speed = {{.time = 0.0, .speed = speed}},
                          .lateral = {{.time = 0.0, .lateral = lateral}}};
  if (brakes && slow < speed) {
    const double slowed = when + (speed - slow) / deceleration;
    motion.speed.push_back({.time = when, .speed = speed});
    motion.speed.push_back({.time = slowed, .speed = slow});
    if (pause < 8.0) {
      motion.speed.push_back({.time = slowed + pause, .speed = slow});
      motion.speed.push_back({.time = slowed + pause + (speed - slow) / 2.0, .speed = speed});
    }
  }
  const double met = TimeToCatch(motion, target, gap);
  AddMoving(body, motion, met, notice, scenario);
  std::string text = fmt::format("{} ahead at {:.1f} m/s", WhatIs(body), speed);
  if (motion.speed.size() > 1)
    text += fmt::format(" that brakes by {:.1f} m/s2 to {:.1f}", deceleration, slow);
  return text + (met > 0.0 ? Noticed(notice) : "");
}

std::string AddOncoming(PointReader reader, sim::Scenario& scenario) {
  const bool present = reader.Chance(0.4);
  Obstacle body = DrawBody(reader);
  const double met = DrawMeeting(reader, scenario);
  const double speed = reader.Uniform(0.3, 1.3) * scenario.route.At(0.0).speed;
  const double from_edge = reader.Uniform(0.2, 0.8), notice = DrawNotice(reader);
  if (!present) return "";
  const control::RoadBounds road = Narrowest(scenario);
  const double room = road.left - road.right - 2.0 * scenario.footprint.half_width - kPassingRoom;
  if (2.0 * body.r_y > room) body = {.r_x = 0.9, .r_y = 0.35, .object_class = ObstacleClass::kCycle};
  const bool yields = 2.0 * body.r_y > room;
  const double lateral = road.left - body.r_y - std::min(from_edge, std::max(0.0, room - 2.0 * body.r_y));
  AddMoving(body,
            {.s = scenario.route.ArcLengthAt(met) + speed * met,
             .heading = std::numbers::pi,
             .speed = {{.time = 0.0, .speed = -speed}},
             .lateral = {{.time = 0.0, .lateral = lateral}},
             .follows = yields},
            met, notice, scenario);
  return fmt::format("{} that comes at {:.1f} m/s{}{}", WhatIs(body), speed, yields ? " and yields" : "",
                     Noticed(notice));
}

std::string AddCrossing(PointReader reader, sim::Scenario& scenario) {
  const bool present = reader.Chance(0.3);
  const double which = reader.Uniform(0.0, 1.0), share = reader.Uniform(0.0, 1.0);
  const double met = DrawMeeting(reader, scenario), early = reader.Uniform(-1.5, 1.5);
  const double lateral = reader.Uniform(-1.0, 1.0), skew = reader.Uniform(-0.35, 0.35);
  const double sign = reader.Sign(), notice = DrawNotice(reader);
  if (!present) return "";
  Obstacle body{.r_x = 0.3, .r_y = 0.3, .object_class = ObstacleClass::kPedestrian};
  double speed = std::lerp(0.8, 2.2, share);
  if (which > 0.8) {
    body = {.r_x = 2.3, .r_y = 0.9, .shape = ObstacleShape::kBox, .object_class = ObstacleClass::kVehicle};
    speed = std::lerp(3.0, 11.0, share);
  } else if (which > 0.45) {
    body = {.r_x = 0.9, .r_y = 0.35, .object_class = ObstacleClass::kCycle};
    speed = std::lerp(2.0, 6.0, share);
  }
  const control::RoutePoint point = scenario.route.At(scenario.route.ArcLengthAt(met));
  const double heading = point.psi + sign * (0.5 * std::numbers::pi + skew);
  const Eigen::Vector2d velocity = speed * control::Along(heading);
  const Eigen::Vector2d start = control::Beside(point, lateral) - velocity * (met - early);
  body.X = start.x();
  body.Y = start.y();
  body.heading = control::WrapAngle(heading);
  body.velocity_X = velocity.x();
  body.velocity_Y = velocity.y();
  std::string text = fmt::format("{} that crosses at {:.1f} m/s{}", WhatIs(body), speed, Noticed(notice));
  Add(body, met, notice, scenario);
  return text;
}

std::string AddGroup(PointReader reader, sim::Scenario& scenario) {
  const bool present = reader.Chance(0.2);
  const double met = DrawMeeting(reader, scenario), span = reader.Uniform(3.0, 30.0);
  const int count = reader.Integer(4, 12);
  const double side = reader.Sign(), gap = reader.Uniform(2.3, 4.5), radius = reader.Uniform(0.15, 0.4);
  const bool people = reader.Chance(0.3);
  const double notice = DrawNotice(reader);
  const double s = scenario.route.ArcLengthAt(met);
  const control::RoadBounds road = scenario.road.At(s);
  const double from = side > 0.0 ? std::max(road.right + gap + radius, 0.0) : road.right + radius;
  const double to = side > 0.0 ? road.left - radius : std::min(road.left - gap - radius, 0.0);
  if (!present || from > to) return "";
  for (int i = 0; i < count; ++i) {
    AddStanding({.r_x = radius,
                 .r_y = radius,
                 .object_class = people ? ObstacleClass::kPedestrian : ObstacleClass::kStatic},
                s + span * Fraction(i * kGolden), std::lerp(from, to, Fraction(i * kPlastic)), 0.0, met,
                notice, scenario);
  }
  return fmt::format("{} {} that leave {:.1f} m{}", count, people ? "people" : "cones", gap, Noticed(notice));
}

std::string AddBeside(PointReader reader, sim::Scenario& scenario) {
  const bool present = reader.Chance(0.4);
  const int count = reader.Integer(3, 10);
  const double which = reader.Uniform(0.0, 1.0), beyond = reader.Uniform(0.05, 1.0);
  const double spread = reader.Uniform(0.0, 3.0), phase = reader.Uniform(0.0, 1.0);
  const double left_share = reader.Uniform(0.0, 1.0);
  if (!present) return "";
  Obstacle body{.r_x = 0.2, .r_y = 0.2, .object_class = ObstacleClass::kStatic};
  const char* name = "cones";
  if (which > 0.7) {
    body = {.r_x = 2.3, .r_y = 0.9, .shape = ObstacleShape::kBox, .object_class = ObstacleClass::kVehicle};
    name = "parked cars";
  } else if (which > 0.35) {
    body.r_x = body.r_y = 0.4;
    name = "trees";
  }
  int added = 0;
  for (int i = 0; i < count; ++i) {
    const double s = scenario.route.length() * Fraction(phase + i * kGolden);
    const control::RoadBounds road = scenario.road.At(s);
    // A long body beside a bend reaches nearer to the road than its middle.
    const double sagitta = 0.5 * body.r_x * body.r_x * std::abs(scenario.route.At(s).curvature);
    const double off = body.r_y + sagitta + beyond + spread * Fraction(i * kPlastic + phase);
    const double lateral = Fraction(i * kPlastic) < left_share ? road.left + off : road.right - off;
    // Beyond a hairpin is the road's other leg.
    const control::RouteProjection place =
        scenario.route.Project(control::Beside(scenario.route.At(s), lateral));
    const control::RoadBounds nearest = scenario.road.At(place.s);
    const bool off_road = place.lateral > nearest.left + body.r_y || place.lateral < nearest.right - body.r_y;
    if (!off_road) continue;
    AddStanding(body, s, lateral, 0.0, 0.0, 0.0, scenario);
    ++added;
  }
  return added == 0 ? "" : fmt::format("{} {} beside the road", added, name);
}

std::string AddParked(PointReader reader, sim::Scenario& scenario) {
  const bool present = reader.Chance(0.35);
  const Obstacle body = DrawBody(reader);
  const double met = DrawMeeting(reader, scenario), covers = reader.Uniform(0.0, 2.5);
  const double side = reader.Sign(), heading = reader.Uniform(-0.15, 0.15), notice = DrawNotice(reader);
  if (!present) return "";
  const double s = scenario.route.ArcLengthAt(met);
  const control::RoadBounds road = scenario.road.At(s);
  const double lateral = side > 0.0 ? road.left + body.r_y - covers : road.right - body.r_y + covers;
  AddStanding(body, s, lateral, heading, met, notice, scenario);
  return fmt::format("{} parked {:.1f} m into the road{}", WhatIs(body), covers, Noticed(notice));
}

}  // namespace tools
