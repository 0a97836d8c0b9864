// An interface that is down, full or gone. The tests use an interface of their own, vcan7.
#include <gtest/gtest.h>
#include <sys/epoll.h>
#include <unistd.h>

#include "can/interface.hpp"
#include "can/socket.hpp"
#include "tests/can/bus.hpp"

namespace can {
namespace {

using std::chrono::milliseconds;

void AddInterface() {
  Ip({"link", "add", "dev", "vcan7", "type", "vcan"});
  Ip({"link", "set", "vcan7", "up"});
}

void DeleteInterface() {
  Ip({"link", "del", "dev", "vcan7"});
}

class Interface : public testing::Test {
 protected:
  void SetUp() override { AddInterface(); }
  void TearDown() override { test_support::Run({"ip", "link", "del", "dev", "vcan7"}); }
};

TEST_F(Interface, DownIsReportedOnceAndUpNeedsNothing) {
  Socket sender("vcan7");
  Socket receiver("vcan7");
  Received received;
  Ip({"link", "set", "vcan7", "down"});
  EXPECT_EQ(ReceiveSoon(receiver, received), ReceiveStatus::kInterfaceDown);
  EXPECT_EQ(receiver.Receive(received), ReceiveStatus::kWouldBlock);
  EXPECT_EQ(sender.Send(MakeFrame(1)), SendStatus::kInterfaceDown);
  EXPECT_EQ(sender.Send(MakeFrame(1)), SendStatus::kInterfaceDown);
  Ip({"link", "set", "vcan7", "up"});
  EXPECT_EQ(sender.Send(MakeFrame(2)), SendStatus::kSent);
  ASSERT_EQ(ReceiveSoon(receiver, received), ReceiveStatus::kFrame);
  EXPECT_EQ(received.frame.id, 2U);
}

TEST_F(Interface, OpenedWhileDownIsReportedAtTheFirstReceive) {
  Ip({"link", "set", "vcan7", "down"});
  Socket socket("vcan7");
  Received received;
  EXPECT_EQ(ReceiveSoon(socket, received), ReceiveStatus::kInterfaceDown);
}

TEST_F(Interface, DeletedAndMadeAnewIsUsedAgainAfterReopen) {
  const SocketOptions options{.filters = {ExactStandardId(0x20)}, .receive_own = true};
  Socket socket("vcan7", options);
  const int epoll = ::epoll_create1(EPOLL_CLOEXEC);
  epoll_event event{.events = EPOLLIN, .data = {}};
  ASSERT_EQ(::epoll_ctl(epoll, EPOLL_CTL_ADD, socket.fd(), &event), 0);
  Received received;
  DeleteInterface();
  EXPECT_EQ(ReceiveSoon(socket, received), ReceiveStatus::kInterfaceGone);
  EXPECT_EQ(socket.Receive(received), ReceiveStatus::kWouldBlock);
  EXPECT_EQ(socket.Send(MakeFrame(0x20)), SendStatus::kInterfaceGone);
  EXPECT_FALSE(socket.Reopen());
  AddInterface();
  EXPECT_EQ(socket.Send(MakeFrame(0x20)), SendStatus::kInterfaceGone) << "bound by Reopen alone";
  ASSERT_TRUE(socket.Reopen());
  EXPECT_EQ(socket.Send(MakeFrame(0x21)), SendStatus::kSent);
  EXPECT_EQ(::epoll_wait(epoll, &event, 1, 50), 0) << "the filters are set again";
  EXPECT_EQ(socket.Send(MakeFrame(0x20)), SendStatus::kSent);
  EXPECT_EQ(::epoll_wait(epoll, &event, 1, 1000), 1) << "still registered";
  ::close(epoll);
  const std::vector<Received> all = Drain(socket);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].frame.id, 0x20U);
  EXPECT_TRUE(all[0].own) << "the options are kept";
  EXPECT_GT(all[0].frame.timestamp, Time{});
}

TEST_F(Interface, ReopenOfASocketThatIsBoundChangesNothing) {
  Socket sender("vcan7");
  Socket receiver("vcan7", {.filters = {ExactStandardId(0x20)}});
  ASSERT_TRUE(receiver.Reopen());
  ASSERT_EQ(sender.Send(MakeFrame(0x20)), SendStatus::kSent);
  ASSERT_EQ(sender.Send(MakeFrame(0x21)), SendStatus::kSent);
  EXPECT_EQ(Drain(receiver).size(), 1U);
}

TEST_F(Interface, FullTransmitQueueIsReported) {
  const auto outcome =
      test_support::Run({"tc", "qdisc", "add", "dev", "vcan7", "root", "pfifo", "limit", "0"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  Socket socket("vcan7");
  EXPECT_EQ(socket.Send(MakeFrame(1)), SendStatus::kQueueFull);
}

TEST_F(Interface, FdFrameOnAnInterfaceWithoutFdIsInvalid) {
  Ip({"link", "set", "vcan7", "down"});
  Ip({"link", "set", "vcan7", "mtu", "16", "up"});
  Socket socket("vcan7", {.fd_frames = true});
  EXPECT_EQ(socket.Send({.id = 1, .fd = true, .length = 8}), SendStatus::kInvalidFrame);
}

TEST(InterfaceKind, VirtualIsWhatItsDriverSays) {
  EXPECT_TRUE(IsVirtual("vcan0"));
  EXPECT_FALSE(IsVirtual("lo"));
  EXPECT_FALSE(IsVirtual("can77"));  // does not exist
  EXPECT_FALSE(IsVirtual("a-name-that-is-too-long"));
}

}  // namespace
}  // namespace can
