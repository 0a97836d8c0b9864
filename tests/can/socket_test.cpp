// Tests of the socket that need no CAN bus; the others are in socket_vcan_test.cpp.
#include "can/socket.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <linux/can.h>
#include <stdexcept>
#include <string>
#include <unistd.h>

namespace can {
namespace {

using std::chrono::milliseconds;

std::string OpeningError(const std::string& interface) {
  try {
    Socket socket(interface);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "opened";
}

TEST(Socket, OpeningAnInterfaceThatDoesNotExistNamesIt) {
  EXPECT_EQ(OpeningError("vcan9"), "no CAN interface \"vcan9\"");
  EXPECT_EQ(OpeningError(""), "no CAN interface \"\"");
  EXPECT_EQ(OpeningError("a_name_too_long_for_any"), "no CAN interface \"a_name_too_long_for_any\"");
}

TEST(Socket, OpeningAnInterfaceOfAnotherKindNamesIt) {
  EXPECT_EQ(OpeningError("lo"), "interface \"lo\" is not a CAN interface");
}

TEST(Filter, ExactFilterTellsStandardExtendedAndRemoteApart) {
  const auto passes = [](const Filter& filter, std::uint32_t id) {
    return ((id ^ filter.id) & filter.mask) == 0;
  };
  const Filter standard = ExactStandardId(0x123);
  EXPECT_TRUE(passes(standard, 0x123));
  EXPECT_FALSE(passes(standard, 0x124));
  EXPECT_FALSE(passes(standard, 0x123 | CAN_EFF_FLAG));
  EXPECT_FALSE(passes(standard, 0x123 | CAN_RTR_FLAG));
  const Filter extended = ExactExtendedId(0x123);
  EXPECT_TRUE(passes(extended, 0x123 | CAN_EFF_FLAG));
  EXPECT_FALSE(passes(extended, 0x123));
  EXPECT_FALSE(passes(extended, 0x10000123 | CAN_EFF_FLAG));
}

TEST(DropCounter, CountsOverTheWrapOfTheKernelsCounter) {
  DropCounter drops;
  drops.Update(5);
  drops.Update(5);
  EXPECT_EQ(drops.total(), 5U);
  drops.Update(std::numeric_limits<std::uint32_t>::max());
  drops.Update(2);
  EXPECT_EQ(drops.total(), (std::uint64_t{1} << 32) + 2);
}

TEST(WaitReadable, TellsDataFromTimeOut) {
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  EXPECT_FALSE(WaitReadable(pipe[0], milliseconds(20)));
  ASSERT_EQ(::write(pipe[1], "x", 1), 1);
  EXPECT_TRUE(WaitReadable(pipe[0], milliseconds(0)));
  ::close(pipe[0]);
  ::close(pipe[1]);
}

}  // namespace
}  // namespace can
