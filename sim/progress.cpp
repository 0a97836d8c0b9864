#include "sim/progress.hpp"

#include <cstdio>
#include <string_view>
#include <unistd.h>

#include "bus/names.hpp"

namespace sim {
Progress::Progress() : next_(std::chrono::steady_clock::now()), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (terminal_ && shown_) std::fputc('\n', stderr);
}

void Progress::Show(const VirtualVehicle& vehicle, const Recorder& recorder) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + (terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(5));
  const std::string_view mode = bus::Name(vehicle.mode());
  std::fprintf(stderr, "%st = %6.2f s, %6.1f m along the route, %5.2f m/s, %-8.*s%s", terminal_ ? "\r" : "",
               vehicle.time(), recorder.arc_length(), vehicle.state()[control::kUpsilon],
               static_cast<int>(mode.size()), mode.data(), terminal_ ? "" : "\n");
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace sim
