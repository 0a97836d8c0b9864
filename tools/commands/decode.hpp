// `lpvmpc decode [LOG|-]`: candump text to the messages of vehicle.dbc in physical units. A line for each
// frame:
//
//   (1700000000.050000) vcan0 VehiclePose X=12.0000 m Y=-3.5000 m | crc ok, counter 7 ok
//
// The CRC is ok or BAD. The counter, judged for each message of each interface, is first, ok (one more than
// in the frame before), repeated, invalid (15), or tells how many frames were lost before this one (modulo
// 15); behind a bad CRC it is not judged. A frame that is none of ours is shown as it came, with what it is
// behind the bar.
#pragma once

#include <istream>
#include <ostream>
#include <string>

namespace tools {

// Reads `in`, called `name` in messages, to its end, and writes each line out as soon as no more input is
// waiting. A line that is no candump text gives "NAME:LINE: ..." on `err`. Returns the exit status: 0, or 1
// if there was such a line or the input could not be read or the output not be written.
[[nodiscard]] int RunDecode(std::istream& in, const std::string& name, std::ostream& out, std::ostream& err);

}  // namespace tools
