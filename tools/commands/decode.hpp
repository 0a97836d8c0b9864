// `lpvmpc decode [LOG|-]`: candump text to the messages of vehicle.dbc in physical units, one line per frame:
//
//   (1700000000.050000) vcan0 VehiclePose X=12.0000 m Y=-3.5000 m | crc ok, counter 7 ok
//
// The CRC is ok or BAD. The counter, judged separately for each message of each interface, is first, ok (one more than
// in the previous frame), repeated, invalid (15), or lost N: N frames (modulo 15) are missing before this one. With a
// bad CRC it is not judged. A frame that is not in vehicle.dbc is shown unchanged, with the reason after the bar.
#pragma once

#include <istream>
#include <ostream>
#include <string>

namespace tools {

// Reads `in`, called `name` in messages, to its end; the output is flushed whenever no more input is waiting. A line
// that is not candump text is reported as "NAME:LINE: ..." on `err`. Returns the exit status: 1 if there was such a
// line, the input could not be read or the output could not be written; otherwise 0.
[[nodiscard]] int RunDecode(std::istream& in, const std::string& name, std::ostream& out, std::ostream& err);

}  // namespace tools
