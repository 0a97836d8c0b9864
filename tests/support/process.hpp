// A child process of a test, started at once and killed at the end of its scope. Its output is kept in files.
//
//   Process daemon({kBinDir + "/lpvmpcd", "--config", config});
//   daemon.Signal(SIGTERM);
//   EXPECT_EQ(daemon.Wait(5s), 0);
//   EXPECT_THAT(daemon.Stderr(), HasSubstr("stopped"));
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <sys/types.h>
#include <thread>
#include <vector>

#include "tests/support/temp_dir.hpp"

namespace test_support {

class Process {
 public:
  // Starts argv[0], looked up in PATH, with an empty stdin. Throws std::runtime_error if that fails.
  explicit Process(const std::vector<std::string>& argv);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void Signal(int signal);

  // The exit status, 128 + N after signal N; nothing if the process still runs after `timeout`.
  [[nodiscard]] std::optional<int> Wait(std::chrono::milliseconds timeout);
  [[nodiscard]] bool Running() { return !Wait(std::chrono::milliseconds(0)).has_value(); }

  // Output so far.
  [[nodiscard]] std::string Stdout() const;
  [[nodiscard]] std::string Stderr() const;

  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  TempDir folder_;
  pid_t pid_ = -1;
  std::optional<int> status_;
};

// The value of line `name` in /proc/PID/status, such as "11512 kB" for "VmRSS"; "" if there is no such line.
[[nodiscard]] std::string ProcStatus(pid_t pid, const std::string& name);

struct Outcome {
  int status = 0;  // as returned by Process::Wait
  std::string out;
  std::string err;
};

// Runs a command to its end. Throws std::runtime_error if that takes longer than `timeout`.
Outcome Run(const std::vector<std::string>& argv,
            std::chrono::milliseconds timeout = std::chrono::seconds(30));

// Polls `condition` every 5 ms until it is true. Returns false if it is not true by `timeout`.
template <typename Condition>
[[nodiscard]] bool WaitUntil(Condition condition,
                             std::chrono::milliseconds timeout = std::chrono::seconds(10)) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace test_support
