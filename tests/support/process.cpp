#include "tests/support/process.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <signal.h>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace test_support {
namespace {

std::string ReadAll(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void Redirect(const char* path, int flags, int fd) {
  const int file = ::open(path, flags | O_CLOEXEC, 0600);
  if (file < 0 || ::dup2(file, fd) < 0) ::_exit(127);
}

}  // namespace

Process::Process(const std::vector<std::string>& argv) {
  std::vector<char*> arguments;
  for (const std::string& argument : argv) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const std::string out = folder_ / "stdout";
  const std::string err = folder_ / "stderr";

  // Through this pipe the child reports why it could not start; a successful exec closes it.
  int failure[2];
  if (::pipe2(failure, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  pid_ = ::fork();
  if (pid_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    Redirect("/dev/null", O_RDONLY, STDIN_FILENO);
    Redirect(out.c_str(), O_WRONLY | O_CREAT | O_APPEND, STDOUT_FILENO);
    Redirect(err.c_str(), O_WRONLY | O_CREAT | O_APPEND, STDERR_FILENO);
    ::execvp(arguments[0], arguments.data());
    const int error = errno;
    if (::write(failure[1], &error, sizeof(error)) < 0) ::_exit(126);
    ::_exit(127);
  }
  ::close(failure[1]);
  int error = 0;
  const bool failed = pid_ < 0 || ::read(failure[0], &error, sizeof(error)) > 0;
  ::close(failure[0]);
  if (failed) {
    if (pid_ > 0) ::waitpid(pid_, nullptr, 0);
    throw std::runtime_error("cannot start " + argv.at(0) + ": " + std::strerror(error));
  }
}

Process::~Process() {
  if (!status_) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
}

void Process::Signal(int signal) {
  if (Running()) ::kill(pid_, signal);
}

std::optional<int> Process::Wait(std::chrono::milliseconds timeout) {
  const auto ended = [this] {
    int status = 0;
    if (!status_ && ::waitpid(pid_, &status, WNOHANG) == pid_) {
      status_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    }
    return status_.has_value();
  };
  if (!WaitUntil(ended, timeout)) return std::nullopt;
  return status_;
}

std::string Process::Stdout() const {
  return ReadAll(folder_ / "stdout");
}

std::string Process::Stderr() const {
  return ReadAll(folder_ / "stderr");
}

std::string ProcStatus(pid_t pid, const std::string& name) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name + ":")) return line.substr(line.find_first_not_of(" \t", name.size() + 1));
  }
  return "";
}

Outcome Run(const std::vector<std::string>& argv, std::chrono::milliseconds timeout) {
  Process process(argv);
  const std::optional<int> status = process.Wait(timeout);
  if (!status) throw std::runtime_error(argv.at(0) + " still runs after its time limit");
  return {*status, process.Stdout(), process.Stderr()};
}

}  // namespace test_support
