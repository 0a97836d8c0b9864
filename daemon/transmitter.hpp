// Sends a cycle's frames, only those that the gate allows, and derives the state of the bus from the result: only sent
// commands bring the bus up.
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

  // `gate` must outlive the transmitter. A frame that the gate does not allow counts as refused by the bus
  // (kInvalidFrame). `clock` gives the time at which the commands were sent.
  Transmitter(const safety::CommandGate& gate, SendFrame send, std::function<base::Time()> clock)
      : gate_(&gate), send_(std::move(send)), clock_(std::move(clock)) {}

  // Sends the frames in order, the pair of commands first, and stops at the first one that cannot be sent: no
  // acceleration is sent without its steering, and no report instead of a command. If a full queue refuses commands
  // three times in a row, the bus is down; a full queue may refuse reports.
  BusState Send(std::span<const can::Frame> frames);

  // Retries while the queue is full, with `wait` between attempts, at most 100 attempts. False if not all frames were
  // sent.
  [[nodiscard]] bool SendLast(std::span<const can::Frame> frames, const std::function<void()>& wait);

  [[nodiscard]] BusState bus() const { return bus_; }
  // Time at which the last Send had sent its pair of commands, before its reports; nullopt if the pair was not sent.
  [[nodiscard]] std::optional<base::Time> commands_left() const { return commands_left_; }
  // Status of the last frame tried: the reason if the bus is not up.
  [[nodiscard]] can::SendStatus last_status() const { return status_; }
  // Frames refused by a full queue in Send, and those left unsent after them.
  [[nodiscard]] std::uint64_t unsent() const { return unsent_; }

 private:
  [[nodiscard]] std::size_t SendInOrder(std::span<const can::Frame> frames);

  const safety::CommandGate* gate_;
  SendFrame send_;
  std::function<base::Time()> clock_;
  BusState bus_ = BusState::kUp;
  can::SendStatus status_ = can::SendStatus::kSent;
  std::optional<base::Time> commands_left_;
  int refused_in_a_row_ = 0;  // Send calls whose commands a full queue refused
  std::uint64_t unsent_ = 0;
};

}  // namespace lpvmpcd
