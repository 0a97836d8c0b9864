// What has been decided about the other things on the road, and why, in a few numbers: for the bus, the log and reports.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace control {

enum class Decision : std::uint8_t {
  kDrive,    // nothing is in the way
  kPass,     // an object is passed
  kFollow,   // an object that moves ahead is followed
  kYield,    // an object that crosses or comes towards the vehicle goes first
  kWait,     // an object that does not move blocks the way
  kSqueeze,  // neither passing nor stopping is possible with the margins: the vehicle uses them up
};

// Why the vehicle goes, or why it does not.
enum class Reason : std::uint8_t {
  // It goes.
  kWayFree,        // there is a way, and nothing to be gained by staying behind
  kStayingCosts,   // staying behind would cost more time
  kCannotStay,     // it cannot stay behind any more
  kLateForNow,     // it was found to be late for its way, but only in the last few cycles
  kTooLateToStop,  // it goes with the least margins, since it cannot stop with the usual ones
  // It stays behind.
  kRoadTooNarrow,       // the road itself is narrower than the vehicle with its least margins
  kNoGap,               // no gap beside the objects is wide enough
  kOncomingFirst,       // an oncoming object takes the gap
  kCrossingFirst,       // an object that crosses the road is in the way then
  kTooLate,             // it would not be out of the way of a moving object in time
  kNoPath,              // the gaps follow one another too closely for the steering
  kPassingGainsLittle,  // there is a way, but it takes hardly less time than staying behind
  kOpenTooShort,        // the way has not been free for long enough
  kNoWay,               // there is no way, and no room to stop either: it brakes
};

// On which side an object is passed, seen in driving direction.
enum class Side : std::int8_t { kNone, kLeft, kRight };

struct ManoeuvreStatus {
  Decision decision = Decision::kDrive;
  Reason reason = Reason::kWayFree;
  int object = -1;           // id of the object that decides; -1: none
  Side side = Side::kNone;   // on which that object is passed; kNone: it is not
  std::size_t left_out = 0;  // objects that matter but are beyond the number that can be considered
  double stop_distance = std::numeric_limits<double>::infinity();  // to the nearest stop line [m]
  double speed_limit = std::numeric_limits<double>::infinity();    // at the vehicle's place [m/s]
};

}  // namespace control
