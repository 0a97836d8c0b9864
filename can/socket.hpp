// A raw SocketCAN socket on one interface.
//
//   can::Socket socket("vcan0", {.filters = {can::ExactStandardId(0x123)}});
//   can::Received received;
//   while (can::WaitReadable(socket.fd(), 100ms))
//     if (socket.Receive(received) == can::ReceiveStatus::kFrame) Use(received.frame);
//
// Nothing blocks, and neither Receive nor Send allocates. Errors while opening throw, later ones are
// statuses. An interface that goes down and comes up again needs no action: the socket stays bound to it.
// After an interface was deleted (kInterfaceGone), Reopen binds to a new one of the same name as soon as it
// exists. The kernel reports such an event once, to the first Receive or Send after it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "can/frame.hpp"

namespace can {

// Accepts a frame if (its id ^ `id`) & `mask` is zero, where bits 31 and 30 of the frame's id mark extended and
// remote frames (linux/can.h). So {0x123, 0x7FF} also matches the extended id 00000123.
struct Filter {
  std::uint32_t id = 0;
  std::uint32_t mask = 0;
};

// Accept only data frames with exactly this id.
[[nodiscard]] Filter ExactStandardId(std::uint32_t id);
[[nodiscard]] Filter ExactExtendedId(std::uint32_t id);

struct SocketOptions {
  std::vector<Filter> filters{};           // a frame is received if any accepts it; empty: all are
  std::uint32_t error_mask = 0;            // error classes received as error frames (linux/can/error.h)
  bool receive_own = false;                // also receive frames sent through this socket, marked as own
  bool fd_frames = false;                  // CAN FD frames can be sent and received
  int receive_buffer_bytes = 1024 * 1024;  // requested; about 770 bytes per frame. The kernel may grant less.
};

struct Received {
  Frame frame;       // stamped by the kernel when it arrived
  bool own = false;  // sent through this socket
};

enum class ReceiveStatus {
  kFrame,          // a frame was received
  kWouldBlock,     // no frame is available now
  kInterfaceDown,  // the interface went down; kWouldBlock follows until it is up again
  kInterfaceGone,  // the interface was deleted; kWouldBlock follows until Reopen succeeds
  kError,          // any other error, see last_error
};

enum class SendStatus {
  kSent,           // handed to the interface
  kQueueFull,      // the transmit queue is full; the frame is not sent
  kInterfaceDown,  // the interface is down
  kInterfaceGone,  // the interface was deleted and Reopen has not succeeded yet
  kInvalidFrame,   // not IsValid, or an FD frame where the socket or the interface has no FD
  kError,          // any other error, see last_error
};

// Follows a 32-bit counter that wraps around.
class DropCounter {
 public:
  void Update(std::uint32_t counter) {
    total_ += static_cast<std::uint32_t>(counter - last_);
    last_ = counter;
  }
  [[nodiscard]] std::uint64_t total() const { return total_; }

 private:
  std::uint32_t last_ = 0;
  std::uint64_t total_ = 0;
};

class Socket {
 public:
  // Throws std::runtime_error, which names the interface, if there is no such interface, if it is not a CAN
  // interface, or if the kernel refuses the socket. An interface that is down is accepted: Receive reports it.
  explicit Socket(std::string interface, SocketOptions options = {});
  ~Socket();
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&& other) noexcept;
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  // Takes the next frame from the receive buffer; `received` is written on kFrame only.
  [[nodiscard]] ReceiveStatus Receive(Received& received);

  [[nodiscard]] SendStatus Send(const Frame& frame);

  // Binds to the interface that has the name now; false if there is none, it is not CAN, or binding fails. The
  // file descriptor stays the same, and so does its place in an epoll instance. Harmless if nothing has changed.
  [[nodiscard]] bool Reopen();

  // Descriptor for epoll and poll: readable when Receive has a frame or an error to return.
  [[nodiscard]] int fd() const { return fd_; }
  [[nodiscard]] const std::string& interface() const { return interface_; }
  // Frames that the kernel dropped because the receive buffer was full, as of the last frame received.
  [[nodiscard]] std::uint64_t dropped() const { return drops_.total(); }
  // Size of the receive buffer granted by the kernel [bytes].
  [[nodiscard]] int receive_buffer_bytes() const { return receive_buffer_bytes_; }
  // The errno of the last kError.
  [[nodiscard]] int last_error() const { return last_error_; }

 private:
  std::string interface_;
  SocketOptions options_;
  int fd_ = -1;
  int receive_buffer_bytes_ = 0;
  int last_error_ = 0;
  DropCounter drops_;
};

// Waits until the file descriptor is readable or has an error, at most `timeout`. False on time-out or if poll fails.
[[nodiscard]] bool WaitReadable(int fd, std::chrono::milliseconds timeout);

}  // namespace can
