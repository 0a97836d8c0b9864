// Helpers of the tests on a real vcan.
#pragma once

#include <cstdint>
#include <gtest/gtest.h>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "can/socket.hpp"
#include "tests/support/process.hpp"

namespace can {

inline Frame MakeFrame(std::uint32_t id, std::initializer_list<int> payload = {}) {
  Frame frame{.id = id, .length = static_cast<std::uint8_t>(payload.size())};
  std::size_t i = 0;
  for (const int byte : payload) frame.data[i++] = static_cast<std::byte>(byte);
  return frame;
}

// The first status of Receive other than kWouldBlock; kWouldBlock if nothing arrives within a second.
inline ReceiveStatus ReceiveSoon(Socket& socket, Received& received) {
  const std::chrono::seconds timeout(1);
  ReceiveStatus status = ReceiveStatus::kWouldBlock;
  while (status == ReceiveStatus::kWouldBlock && WaitReadable(socket.fd(), timeout))
    status = socket.Receive(received);
  return status;
}

// All frames in the receive buffer.
inline std::vector<Received> Drain(Socket& socket) {
  std::vector<Received> all;
  Received received;
  while (socket.Receive(received) == ReceiveStatus::kFrame) all.push_back(received);
  return all;
}

inline void Ip(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "ip");
  const auto outcome = test_support::Run(arguments);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
}

}  // namespace can
