// Duties of the process besides driving: real time, reload, log, lock step.
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <gmock/gmock.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/integration/daemon_on_bus.hpp"

namespace lpvmpcd {
namespace {

using bus::Mode;
using testing::HasSubstr;
using testing::Not;

class DaemonService : public DaemonOnBus {
 protected:
  void Configure(const std::string& text) const {
    std::ofstream(folder_ / "daemon.toml") << "[route]\nfile = \"route.toml\"\n" + text;
  }
  // Starts the daemon through `command`, which must execute the arguments appended to it.
  void StartBy(std::vector<std::string> command) {
    for (const std::string& argument :
         {std::string(LPVMPCD), std::string("--config"), (folder_ / "daemon.toml").string(),
          std::string("--interface"), interface_}) {
      command.push_back(argument);
    }
    daemon_.emplace(command);
    ASSERT_TRUE(NextPair(10s));  // sent by the timer: the daemon is listening
  }
  void Reload(const std::string& text) {
    Configure(text);
    daemon_->Signal(SIGHUP);
  }
};

TEST_F(DaemonService, GetsTheRealTimeThatItAsksForAndSaysSo) {
  // Where this process lacks the privilege (a user namespace), the daemon gets no real time either.
  const bool may = test_support::Run({"chrt", "-f", "10", "true"}).status == 0;
  Configure("[realtime]\nfifo_priority = 10\nlock_memory = true\ncpus = [0]\n");
  StartDaemon();
  EXPECT_EQ(::sched_getscheduler(daemon_->pid()) == (SCHED_FIFO | SCHED_RESET_ON_FORK), may);
  EXPECT_EQ(test_support::ProcStatus(daemon_->pid(), "Cpus_allowed_list"), "0");
  EXPECT_TRUE(LogSays("real time: cpus 0"));
  if (may) {
    EXPECT_TRUE(LogSays("real time: cpus 0, memory locked, SCHED_FIFO 10"));
    EXPECT_THAT(daemon_->Stderr(), Not(HasSubstr("refused")));
    EXPECT_GT(std::stoi(test_support::ProcStatus(daemon_->pid(), "VmLck")), 1000);
  }
  Engage();
  EXPECT_EQ(Period().steering.mode, bus::Mode::kActive);
  EXPECT_LT(std::stoi(test_support::ProcStatus(daemon_->pid(), "VmRSS")), 20 * 1024) << "kB";
  std::printf("resident with locked memory: %s\n", test_support::ProcStatus(daemon_->pid(), "VmRSS").c_str());
}

TEST_F(DaemonService, RunsWithoutTheRealTimeThatItIsRefusedAndNamesIt) {
  Configure("[realtime]\nfifo_priority = 10\nlock_memory = true\ncpus = [0, 1023]\n");
  StartBy({"prlimit", "--memlock=65536:65536", "--rtprio=0:0", "setpriv", "--bounding-set=-all",
           "--inh-caps=-all"});
  EXPECT_TRUE(LogSays("real time: cpu 1023 refused: there is none"));
  EXPECT_TRUE(LogSays("real time: lock_memory refused: Cannot allocate memory"));
  EXPECT_TRUE(LogSays("real time: fifo_priority 10 refused: Operation not permitted"));
  EXPECT_TRUE(LogSays("real time: cpus 0"));
  Engage();
  EXPECT_EQ(Period().steering.mode, bus::Mode::kActive);
}

TEST_F(DaemonService, ReloadTakesAllOrNothing) {
  Configure("[log]\nlevel = \"info\"\n");
  StartDaemon();
  Engage();
  Reload("[log]\nlevel = \"warning\"\n[engage]\nmin_speed = 12\n");
  EXPECT_TRUE(
      LogSays("configuration not reloaded: engage.min_speed cannot change while commands are enabled"));
  vehicle_.request.engage = false;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);
  EXPECT_TRUE(LogSays("mode Active -> Standby"));  // so the level has not changed

  Reload("[log]\nlevel = \"info\"\n[engage]\nmin_speed = 12\n");
  EXPECT_TRUE(LogSays("configuration reloaded: engage.min_speed"));
  vehicle_.request.engage = true;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);  // at 10 m/s

  Reload("[log]\nlevel = \"info\"\n[engage]\nmin_speed = 3\n[cycle]\nperiod = 0.04\n");
  EXPECT_TRUE(LogSays("configuration not reloaded: cycle.period needs a restart"));
  Reload("[log]\nlevel = \"loud\"\n");
  EXPECT_TRUE(LogSays("daemon.toml:4: key 'log.level' = \"loud\""));
  vehicle_.request.engage = false;
  Period();
  vehicle_.request.engage = true;
  EXPECT_EQ(Period().steering.mode, bus::Mode::kStandby);  // neither was applied

  // The interface of the command line overrides that of the file.
  Reload("[bus]\ninterface = \"can7\"\n[log]\nlevel = \"warning\"\n");
  EXPECT_TRUE(LogSays("configuration reloaded: engage.min_speed, log.level"));
  Engage();
  EXPECT_EQ(Period().steering.mode, bus::Mode::kActive);
  EXPECT_THAT(daemon_->Stderr(), Not(HasSubstr("can7")));
}

TEST_F(DaemonService, ReaderOfTheLogThatStallsDoesNotStallTheDaemon) {
  const std::filesystem::path log = folder_ / "log";
  ASSERT_EQ(test_support::Run({"mkfifo", log.string()}).status, 0);
  const int reader = ::open(log.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ::fcntl(reader, F_SETPIPE_SZ, 8192);
  StartBy({"sh", "-c", "exec \"$@\" 2> " + log.string(), "sh"});
  Engage();
  // Each signal logs about a hundred characters; together they do not fit into the pipe.
  for (int i = 0; i < 100; ++i) {
    daemon_->Signal(SIGUSR1);
    ASSERT_EQ(Period().steering.mode, bus::Mode::kActive) << i;
  }
  std::string text(1 << 20, '\0');
  EXPECT_GT(::read(reader, text.data(), text.size()), 2000);
  daemon_->Signal(SIGUSR1);
  EXPECT_TRUE(test_support::WaitUntil([&] {
    const ssize_t size = ::read(reader, text.data(), text.size());
    return size > 0 &&
           text.substr(0, static_cast<std::size_t>(size)).find("log lines lost: ") != std::string::npos;
  }));
  ::close(reader);
}

// A socket in place of the journal's, in a mount namespace private to the daemon.
class DaemonWithJournal : public DaemonService {
 protected:
  DaemonWithJournal() {
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    (journal_folder_ + "/socket").copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(::bind(journal_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    StartBy({"unshare", "--mount", "sh", "-c",
             "mount -t tmpfs tmpfs /run && mkdir -p /run/systemd/journal && mount --bind " + journal_folder_ +
                 " /run/systemd/journal && JOURNAL_STREAM=$(stat -L -c %d:%i /proc/self/fd/2) exec \"$@\"",
             "sh"});
  }
  ~DaemonWithJournal() override {
    ::close(journal_);
    std::filesystem::remove_all(journal_folder_);
  }
  // The next entry whose message begins with `message`, with all its fields; empty if none arrives in time.
  std::string Entry(const std::string& message) const {
    std::string entry(4096, '\0');
    const auto end = steady_clock::now() + 10s;  // other lines may keep coming
    while (steady_clock::now() < end && can::WaitReadable(journal_, 2s)) {
      const ssize_t size = ::recv(journal_, entry.data(), entry.size(), 0);
      std::string text = entry.substr(0, static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
      if (Field(text, "MESSAGE").starts_with(message)) return text;
    }
    return "";
  }
  static std::string Field(const std::string& entry, const std::string& name) {
    const std::size_t at = ("\n" + entry).find("\n" + name + "\n");
    if (at == std::string::npos) return "";
    const std::size_t length = at + name.size() + 1;
    return entry.substr(length + 8, static_cast<unsigned char>(entry.at(length)));
  }

  std::string journal_folder_ = [] {
    std::string name = "/dev/shm/lpvmpcd.XXXXXX";
    return std::string(::mkdtemp(name.data()));
  }();
  int journal_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
};

TEST_F(DaemonWithJournal, ChangesOfModeAndFaultsHaveFieldsAndNoLineIsThereTwice) {
  Engage();
  std::string entry = Entry("mode Standby -> Active");
  EXPECT_EQ(Field(entry, "LPVMPCD_MODE"), "Active");
  EXPECT_EQ(Field(entry, "LPVMPCD_CAUSE"), "engaged");
  EXPECT_EQ(Field(entry, "LPVMPCD_FAULT"), "");
  EXPECT_EQ(Field(entry, "PRIORITY"), "6");
  EXPECT_EQ(Field(entry, "SYSLOG_IDENTIFIER"), "lpvmpcd");
  UntilSafeStop([] { return std::vector<can::Frame>{}; });
  entry = Entry("mode Degraded -> SafeStop");
  EXPECT_EQ(Field(entry, "LPVMPCD_MODE"), "SafeStop");
  EXPECT_EQ(Field(entry, "LPVMPCD_FAULT"), "vehicle state stale");
  EXPECT_EQ(Field(entry, "PRIORITY"), "4");
  EXPECT_EQ(daemon_->Stderr(), "");
}

TEST_F(DaemonWithJournal, JournalThatStallsDoesNotStallTheDaemon) {
  Engage();
  for (int i = 0; i < 700; ++i) {  // more than its queue holds: 512 where systemd has raised the limit
    daemon_->Signal(SIGUSR1);
    if (i % 10 == 0) {
      ASSERT_TRUE(bus::Drives(Period().steering.mode)) << i;
    }
  }
  EXPECT_NE(Entry("cycle latency"), "");  // there is room again
  daemon_->Signal(SIGUSR1);
  EXPECT_NE(Entry("log lines lost: "), "");
}

TEST_F(DaemonService, LocksStepOnAVirtualInterface) {
  daemon_.emplace(std::vector<std::string>{LPVMPCD, "--config", (folder_ / "daemon.toml").string(),
                                           "--interface", interface_, "--lockstep"});
  EXPECT_TRUE(LogSays("listening on " + interface_ + " in lock step"));
}

}  // namespace
}  // namespace lpvmpcd
