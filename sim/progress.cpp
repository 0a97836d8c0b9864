#include "sim/progress.hpp"

#include <array>
#include <cstdio>
#include <unistd.h>

namespace sim {
namespace {

constexpr std::array<const char*, 6> kModeNames{"Init", "Standby", "Active", "Degraded", "SafeStop", "Fault"};

}  // namespace

Progress::Progress() : next_(std::chrono::steady_clock::now()), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (terminal_ && shown_) std::fputc('\n', stderr);
}

void Progress::Show(const VirtualVehicle& vehicle, const Recorder& recorder) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + (terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(5));
  std::fprintf(stderr, "%st = %6.2f s, %6.1f m along the route, %5.2f m/s, %-8s%s", terminal_ ? "\r" : "",
               vehicle.time(), recorder.arc_length(), vehicle.state()[control::kUpsilon],
               kModeNames[static_cast<std::size_t>(vehicle.mode())], terminal_ ? "" : "\n");
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace sim
