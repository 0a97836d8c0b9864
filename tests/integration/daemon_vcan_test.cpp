#include <future>
#include <gmock/gmock.h>

#include "tests/integration/daemon_on_bus.hpp"

namespace lpvmpcd {
namespace {

using bus::Mode;
using test_support::Run;
using testing::HasSubstr;

void Ip(const std::vector<std::string>& arguments) {
  std::vector<std::string> argv{"ip", "link"};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  const auto outcome = Run(argv);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
}

class DaemonVcan : public DaemonOnBus {};

TEST_F(DaemonVcan, CommandsNothingUntilTheDriverAsksAndThenAnswersEveryState) {
  StartDaemon();
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(Period().steering.enable);
  }
  vehicle_.request.engage = true;
  for (int i = 0; i < 60; ++i) {
    const CommandPair pair = Period();
    EXPECT_EQ(pair.steering.mode, bus::Mode::kActive);
    EXPECT_EQ(pair.steering.plan_age, 0);
    // The vehicle is on its reference.
    EXPECT_NEAR(pair.steering.delta, 0.0, 0.01);
    EXPECT_NEAR(pair.acceleration.acceleration, 0.0, 0.1);
  }
}

TEST_F(DaemonVcan, RequestHeldFromTheFirstFrameOnDoesNotEngage) {
  vehicle_.request.engage = true;
  StartDaemon();
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(Period().steering.enable);
  }
}

TEST_F(DaemonVcan, OverrideWinsAtOnceAndNeedsANewRequest) {
  StartDaemon();
  for (const bool brake : {true, false}) {
    Engage();
    (brake ? vehicle_.request.brake : vehicle_.request.steering_override) = true;
    EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);
    vehicle_.request = {.engage = true};
    for (int i = 0; i < 5; ++i) {
      EXPECT_FALSE(Period().steering.enable);
    }
  }
  EXPECT_THAT(daemon_->Stderr(), HasSubstr("mode Active -> Standby: driver override"));
}

TEST_F(DaemonVcan, StaleStateIsPredictedAndThenEndsInAControlledStop) {
  StartDaemon();
  Engage();
  const auto pairs = UntilSafeStop([] { return std::vector<can::Frame>{}; });
  ASSERT_GE(pairs.size(), 2U);
  for (std::size_t i = 0; i + 1 < pairs.size(); ++i) {
    EXPECT_EQ(pairs[i].steering.mode, bus::Mode::kDegraded);
    EXPECT_EQ(pairs[i].steering.state_counter, 15);
    EXPECT_EQ(pairs[i].steering.plan_age, 0);  // made for the predicted state
  }
  double a = pairs.back().acceleration.acceleration;
  EXPECT_NEAR(a, -1.5, 0.1);  // no jump
  for (int i = 0; i < 3; ++i) {
    PeriodWithoutState({});
  }
  std::optional<CommandPair> last;
  while (const auto pair = NextPair(1ms)) {
    last = pair;
  }
  ASSERT_TRUE(last);
  EXPECT_EQ(last->steering.mode, bus::Mode::kSafeStop);
  EXPECT_NEAR(last->acceleration.acceleration, -3.0, 0.01);
  EXPECT_EQ(Fault(), bus::FaultCode::kStateStale);

  // The state returns, with the vehicle at standstill. It is held there, and drives on.
  vehicle_.motion.upsilon = 0.0;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(Period().steering.mode, bus::Mode::kSafeStop);
  EXPECT_EQ(Period().steering.mode, bus::Mode::kActive);
  EXPECT_TRUE(LogSays("mode SafeStop -> Active: recovered"));
}

TEST_F(DaemonVcan, CorruptedStatesChangeNothingAndManyOfThemStopTheVehicle) {
  StartDaemon();
  Engage();
  const auto corrupted = [this] {
    auto frames = vehicle_.State();
    frames[0].data[6] ^= std::byte{0x40};  // a position hundreds of metres away, if it were believed
    return frames;
  };
  PeriodWithoutState(corrupted());
  while (const auto pair = NextPair(1ms)) {
    EXPECT_EQ(pair->steering.mode, bus::Mode::kDegraded);
    EXPECT_EQ(pair->steering.state_counter, 15);
  }
  EXPECT_EQ(Period().steering.mode, bus::Mode::kActive);  // a single one is bridged

  for (const CommandPair& pair : UntilSafeStop(corrupted)) {
    EXPECT_EQ(pair.steering.state_counter, 15);
    EXPECT_NEAR(pair.steering.delta, 0.0, 0.01);
  }
  EXPECT_EQ(Fault(), bus::FaultCode::kStateInvalid);
  EXPECT_TRUE(LogSays("refused: wrong CRC"));
}

TEST_F(DaemonVcan, RepeatedStateGetsNoAnswerAndMakesNothingFresh) {
  StartDaemon();
  Engage();
  vehicle_.pose.X += 0.5;
  const auto frozen = vehicle_.State();
  Put(vehicle_.Request());
  Put(vehicle_.Obstacles());
  Put(frozen);
  EXPECT_EQ(Answer().steering.mode, bus::Mode::kActive);
  for (const CommandPair& pair : UntilSafeStop([&] { return frozen; })) {
    EXPECT_EQ(pair.steering.state_counter, 15);
  }
  EXPECT_TRUE(LogSays("refused: repeated counter"));
}

TEST_F(DaemonVcan, KilledAndRestartedItCommandsNothingByItself) {
  StartDaemon();
  Engage();
  daemon_->Signal(SIGKILL);
  ASSERT_EQ(daemon_->Wait(5s), 128 + SIGKILL);
  Forget();
  StartDaemon();
  CommandPair pair = Period();
  EXPECT_EQ(pair.steering.mode, bus::Mode::kInit);
  for (int i = 0; i < 20; ++i) {
    pair = Period();  // engage is still requested
    EXPECT_FALSE(pair.steering.enable);
  }
  EXPECT_EQ(pair.steering.mode, bus::Mode::kStandby);
  Engage();
}

TEST_F(DaemonVcan, InterfaceThatIsDownForLessThanTwoSecondsStopsTheVehicleUntilItIsUp) {
  StartDaemon();
  Engage();
  // The vehicle keeps moving, since the kernel may need seconds to take an interface down.
  const auto down = std::async(std::launch::async, [this] { Ip({"set", interface_, "down"}); });
  while (down.wait_for(50ms) != std::future_status::ready) {
    vehicle_.pose.X += 0.5;
    for (const can::Frame& frame : vehicle_.All()) static_cast<void>(socket_.Send(frame));
  }
  EXPECT_TRUE(LogSays(interface_ + " is down"));
  EXPECT_TRUE(LogSays("-> SafeStop: bus down"));
  std::this_thread::sleep_for(300ms);
  EXPECT_TRUE(daemon_->Running());
  Ip({"set", interface_, "up"});
  EXPECT_TRUE(LogSays(interface_ + " is up"));
  Forget();

  // The daemon brakes on until all inputs have been healthy for a while, then drives on, since the driver still asks.
  EXPECT_EQ(Period().steering.mode, bus::Mode::kSafeStop);
  bus::Mode mode = bus::Mode::kSafeStop;
  for (int i = 0; i < 10 && mode == bus::Mode::kSafeStop; ++i) mode = Period().steering.mode;
  EXPECT_EQ(mode, bus::Mode::kActive);
  EXPECT_TRUE(LogSays("mode SafeStop -> Active: recovered"));
}

// States received during a pause are not answered, except the newest: late commands would be worse than none.
TEST_F(DaemonVcan, AfterAPauseOnlyTheNewestStateIsAnswered) {
  StartDaemon();
  Engage();
  // Twelve states of a modulo-15 counter: the first and the last alone would not determine their number.
  for (const int states : {6, 12}) {
    daemon_->Signal(SIGSTOP);
    Forget();
    for (int i = 0; i < states; ++i) {
      std::this_thread::sleep_for(50ms);
      vehicle_.pose.X += 0.5;
      Put(vehicle_.All());
    }
    daemon_->Signal(SIGCONT);
    const auto pair = NextPair();
    ASSERT_TRUE(pair);
    if (pair->steering.state_counter != 15) {  // on a loaded machine even the newest may have waited too long
      EXPECT_EQ(pair->steering.state_counter, vehicle_.last_state_counter());
      EXPECT_EQ(pair->steering.mode, bus::Mode::kActive);
    }
    for (int i = 0; i < 2; ++i) {
      const auto later = NextPair(100ms);
      ASSERT_TRUE(later);
      EXPECT_EQ(later->steering.state_counter, 15) << "one answer is enough";
    }
    // The place on the route is right: the vehicle has nothing to catch up.
    EXPECT_NEAR(Period().acceleration.acceleration, 0.0, 0.3);
  }
}

TEST_F(DaemonVcan, TellsItsLatenciesWhenAskedAndAtTheEnd) {
  StartDaemon();
  Engage();
  daemon_->Signal(SIGUSR1);
  EXPECT_TRUE(LogSays("cycle latency median "));
  EXPECT_TRUE(LogSays("control step median "));
  EXPECT_EQ(Period().steering.mode, bus::Mode::kActive);
  daemon_->Signal(SIGTERM);
  EXPECT_EQ(daemon_->Wait(5s), 0);
  const std::string log = daemon_->Stderr();
  EXPECT_THAT(log.substr(log.find("stopped after")), HasSubstr("cycle latency median "));
}

TEST_F(DaemonVcan, StoppedForLongAndContinuedItCommandsNothing) {
  StartDaemon();
  Engage();
  daemon_->Signal(SIGSTOP);
  for (int i = 0; i < 3; ++i) {  // frames sent in the meantime wait in the daemon's queue
    Put(vehicle_.All());
    std::this_thread::sleep_for(1s);
  }
  Forget();
  daemon_->Signal(SIGCONT);
  while (const auto pair = NextPair(300ms)) {
    EXPECT_FALSE(pair->steering.enable);
    if (pair->steering.state_counter == 15) break;  // sent by the timer: the queue is empty
  }
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(Period().steering.enable);
  }
  EXPECT_TRUE(LogSays("mode Active -> Fault: no command sent for too long"));
  Engage();
}

TEST_F(DaemonVcan, ReaderOfTheLogThatGoesAwayDoesNotEndTheDaemon) {
  // `exec` makes the process the daemon itself; only the first line of its log is read.
  const std::string command = "mkfifo log && { head -n 1 log & } && exec \"$0\" \"$@\" 2> log";
  daemon_.emplace(std::vector<std::string>{"sh", "-c", "cd " + folder_.path().string() + " && " + command,
                                           LPVMPCD, "--config", "daemon.toml", "--interface", interface_});
  ASSERT_TRUE(test_support::WaitUntil([&] { return !daemon_->Stdout().empty(); }));
  Engage();  // logged in two lines
  EXPECT_TRUE(Period().steering.enable);
  daemon_->Signal(SIGTERM);
  EXPECT_EQ(daemon_->Wait(5s), 0);
}

TEST_F(DaemonVcan, SigtermAndSigintSendALastPairThatIsNotEnabled) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Forget();
    StartDaemon();
    Engage();
    daemon_->Signal(signal);
    EXPECT_EQ(daemon_->Wait(5s), 0);
    std::optional<CommandPair> last;
    while (const auto pair = NextPair(1ms)) {
      last = pair;
    }
    ASSERT_TRUE(last);
    EXPECT_FALSE(last->steering.enable);
    EXPECT_FALSE(last->acceleration.enable);
    EXPECT_EQ(last->steering.state_counter, 15);
    EXPECT_THAT(daemon_->Stderr(), HasSubstr("stopped after"));
  }
}

// Uses a separate interface, which is deleted.
class DaemonOnPassingInterface : public DaemonOnBus {
 protected:
  DaemonOnPassingInterface() : DaemonOnBus("vcan9") {}
  static void SetUpTestSuite() { Create(); }
  static void TearDownTestSuite() { Ip({"del", "vcan9"}); }
  static void Create() {
    Ip({"add", "dev", "vcan9", "type", "vcan"});
    Ip({"set", "vcan9", "up"});
  }
};

TEST_F(DaemonOnPassingInterface, InterfaceDeletedAndMadeAgainIsTakenUp) {
  StartDaemon();
  Engage();
  Ip({"del", interface_});
  EXPECT_TRUE(LogSays(interface_ + " is gone"));
  EXPECT_TRUE(daemon_->Running());
  can::Received ignored;
  EXPECT_TRUE(test_support::WaitUntil(
      [&] { return socket_.Receive(ignored) == can::ReceiveStatus::kInterfaceGone; }));
  Create();
  EXPECT_TRUE(LogSays(interface_ + " is back"));
  EXPECT_TRUE(LogSays(interface_ + " is up"));
  EXPECT_TRUE(socket_.Reopen());
  Forget();
  vehicle_.motion.upsilon = 0.0;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kSafeStop);
  bus::Mode mode = bus::Mode::kSafeStop;
  for (int i = 0; i < 10 && mode == bus::Mode::kSafeStop; ++i) mode = Period().steering.mode;
  EXPECT_EQ(mode, bus::Mode::kActive);
}

}  // namespace
}  // namespace lpvmpcd
