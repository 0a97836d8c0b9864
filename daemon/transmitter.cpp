#include "daemon/transmitter.hpp"

#include <algorithm>

namespace lpvmpcd {
namespace {

constexpr std::size_t kCommands = 2;
constexpr int kRefusedUntilDown = 3;
constexpr int kLastAttempts = 100;

}  // namespace

BusState Transmitter::Send(std::span<const can::Frame> frames) {
  const std::size_t commands = std::min(frames.size(), kCommands);
  std::size_t sent = SendInOrder(frames.first(commands));
  commands_left_.reset();
  if (sent == commands) {
    commands_left_ = clock_();
    refused_in_a_row_ = 0;
    bus_ = BusState::kUp;
    sent += SendInOrder(frames.subspan(commands));
  }
  switch (status_) {
    case can::SendStatus::kSent:
      break;
    case can::SendStatus::kQueueFull:
      unsent_ += frames.size() - sent;
      if (sent < kCommands && ++refused_in_a_row_ >= kRefusedUntilDown) {
        bus_ = BusState::kDown;
      }
      break;
    case can::SendStatus::kInterfaceGone:
      bus_ = BusState::kGone;
      break;
    case can::SendStatus::kInterfaceDown:
    case can::SendStatus::kInvalidFrame:
    case can::SendStatus::kError:
      bus_ = BusState::kDown;
      break;
  }
  return bus_;
}

bool Transmitter::SendLast(std::span<const can::Frame> frames, const std::function<void()>& wait) {
  for (int attempt = 1;; ++attempt) {
    frames = frames.subspan(SendInOrder(frames));
    if (frames.empty() || status_ != can::SendStatus::kQueueFull || attempt == kLastAttempts) {
      return frames.empty();
    }
    wait();
  }
}

std::size_t Transmitter::SendInOrder(std::span<const can::Frame> frames) {
  status_ = can::SendStatus::kSent;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    status_ = gate_->MaySend(frames[i]) ? send_(frames[i]) : can::SendStatus::kInvalidFrame;
    if (status_ != can::SendStatus::kSent) {
      return i;
    }
  }
  return frames.size();
}

}  // namespace lpvmpcd
