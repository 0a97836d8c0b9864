// Sends a cycle's frames, those that the gate lets through and no other, and tells from it how the bus is: up if our commands go out, and in no other case.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "base/time.hpp"
#include "can/frame.hpp"
#include "can/socket.hpp"
#include "safety/command_gate.hpp"

namespace lpvmpcd {

enum class BusState : std::uint8_t { kUp, kDown, kGone };  // from good to bad

class Transmitter {
 public:
  using SendFrame = std::function<can::SendStatus(const can::Frame&)>;

  // `gate` must outlive the transmitter. A frame that may not be sent counts as one that the bus refuses
  // (kInvalidFrame). `clock` tells when commands have left.
  Transmitter(const safety::CommandGate& gate, SendFrame send, std::function<base::Time()> clock)
      : gate_(&gate), send_(std::move(send)), clock_(std::move(clock)) {}

  // In order, the pair of commands first; ends with the first frame that is not sent, so that neither an
  // acceleration goes out without its steering nor a report in place of a command. A full queue that refuses
  // commands three times in a row is a bus that is down; reports it may refuse.
  BusState Send(std::span<const can::Frame> frames);

  // Tries again while the queue is full, `wait` between two attempts, at most a hundred of them. False: not all
  // were sent.
  [[nodiscard]] bool SendLast(std::span<const can::Frame> frames, const std::function<void()>& wait);

  [[nodiscard]] BusState bus() const { return bus_; }
  // When the pair of commands of the last Send had left, its reports still to follow; nothing if it did not leave.
  [[nodiscard]] std::optional<base::Time> commands_left() const { return commands_left_; }
  // Of the last frame tried: the reason, if the bus is not up.
  [[nodiscard]] can::SendStatus last_status() const { return status_; }
  // Frames that a full queue refused, and those left unsent after them.
  [[nodiscard]] std::uint64_t unsent() const { return unsent_; }

 private:
  [[nodiscard]] std::size_t SendInOrder(std::span<const can::Frame> frames);

  const safety::CommandGate* gate_;
  SendFrame send_;
  std::function<base::Time()> clock_;
  BusState bus_ = BusState::kUp;
  can::SendStatus status_ = can::SendStatus::kSent;
  std::optional<base::Time> commands_left_;
  int refused_in_a_row_ = 0;  // commands
  std::uint64_t unsent_ = 0;
};

}  // namespace lpvmpcd
