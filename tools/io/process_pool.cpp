#include "tools/io/process_pool.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace tools {
namespace {

struct Child {
  pid_t pid;
  int pipe;
  std::size_t item;
  std::string text;
};

void WriteAll(int file, const std::string& text) {
  for (std::size_t written = 0; written < text.size();) {
    const ssize_t n = write(file, text.data() + written, text.size() - written);
    if (n < 0 && errno != EINTR) return;  // the reading end is closed
    written += static_cast<std::size_t>(std::max<ssize_t>(n, 0));
  }
}

[[noreturn]] void RunChild(int pipe, std::size_t item, const std::function<std::string(std::size_t)>& work) {
  bool good = true;
  std::string text;
  try {
    text = work(item);
  } catch (const std::exception& error) {
    good = false;
    text = error.what();
  }
  WriteAll(pipe, text);
  _exit(good ? 0 : 1);  // neither flushes nor destroys the parent's objects a second time
}

class Children {
 public:
  ~Children() {
    for (const Child& child : children_) kill(child.pid, SIGKILL);
    for (const Child& child : children_) {
      waitpid(child.pid, nullptr, 0);
      close(child.pipe);
    }
  }

  [[nodiscard]] std::size_t size() const { return children_.size(); }

  void Start(std::size_t item, const std::function<std::string(std::size_t)>& work) {
    int ends[2];
    if (pipe(ends) != 0)
      throw std::runtime_error(fmt::format("cannot create a pipe: {}", std::strerror(errno)));
    const pid_t pid = fork();
    if (pid == 0) {
      close(ends[0]);
      RunChild(ends[1], item, work);
    }
    close(ends[1]);
    if (pid < 0) {
      close(ends[0]);
      throw std::runtime_error(fmt::format("cannot create a process: {}", std::strerror(errno)));
    }
    children_.push_back({.pid = pid, .pipe = ends[0], .item = item, .text = {}});
  }

  // Waits until a child has ended. Throws std::runtime_error if it failed.
  [[nodiscard]] std::pair<std::size_t, std::string> Next() {
    for (;;) {
      std::vector<pollfd> polls;
      polls.reserve(children_.size());
      for (const Child& child : children_)
        polls.push_back({.fd = child.pipe, .events = POLLIN, .revents = 0});
      if (poll(polls.data(), polls.size(), -1) < 0 && errno != EINTR) {
        throw std::runtime_error(fmt::format("poll: {}", std::strerror(errno)));
      }
      for (std::size_t i = 0; i < polls.size(); ++i) {
        if (polls[i].revents == 0) continue;
        char buffer[4096];
        const ssize_t n = read(children_[i].pipe, buffer, sizeof buffer);
        if (n > 0) children_[i].text.append(buffer, static_cast<std::size_t>(n));
        if (n == 0) return Reap(i);
      }
    }
  }

 private:
  std::pair<std::size_t, std::string> Reap(std::size_t i) {
    const Child child = std::move(children_[i]);
    children_.erase(children_.begin() + static_cast<std::ptrdiff_t>(i));
    int status = 0;
    waitpid(child.pid, &status, 0);
    close(child.pipe);
    if (WIFSIGNALED(status)) {
      throw std::runtime_error(fmt::format("item {}: ended by signal {}", child.item, WTERMSIG(status)));
    }
    if (WEXITSTATUS(status) != 0)
      throw std::runtime_error(fmt::format("item {}: {}", child.item, child.text));
    return {child.item, child.text};
  }

  std::vector<Child> children_;
};

}  // namespace

std::vector<std::string> MapInProcesses(std::size_t count, int jobs,
                                        const std::function<std::string(std::size_t)>& work,
                                        const std::function<void()>& done) {
  std::vector<std::string> results(count);
  Children children;
  std::size_t started = 0;
  for (std::size_t ended = 0; ended < count; ++ended) {
    while (started < count && children.size() < static_cast<std::size_t>(std::max(jobs, 1))) {
      children.Start(started++, work);
    }
    const auto [item, text] = children.Next();
    results[item] = text;
    if (done) done();
  }
  return results;
}

}  // namespace tools
