#include "daemon/log.hpp"

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fmt/format.h>
#include <memory>
#include <poll.h>
#include <spdlog/details/null_mutex.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "base/file_descriptor.hpp"

namespace lpvmpcd {
namespace {

LogFields fields_of_line;

// Common base of both sinks: a line is written, or dropped and counted.
class Sink : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 protected:
  // False if there is no room for the line now.
  virtual bool Write(spdlog::level::level_enum level, std::string_view line) = 0;

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    if (dropped_ > 0 && Write(spdlog::level::warn, fmt::format("log lines lost: {}\n", dropped_))) {
      dropped_ = 0;
    }
    dropped_ += Write(message.level, {line.data(), line.size()}) ? 0 : 1;
  }
  void flush_() override {}

  std::uint64_t dropped_ = 0;
};

// Polls for room first: stderr must not be made non-blocking, because other processes may share the terminal.
class StderrSink : public Sink {
  bool Write(spdlog::level::level_enum /*level*/, std::string_view line) override {
    pollfd item{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
    if (::poll(&item, 1, 0) != 1 || (item.revents & POLLOUT) == 0) {
      return false;
    }
    // There is room for at least PIPE_BUF bytes, and a line is shorter.
    return ::write(STDERR_FILENO, line.data(), line.size()) >= 0;
  }
};

// Uses the journal's native protocol, one datagram per line, instead of sd_journal_send, which blocks while journald
// does not read.
class JournalSink : public Sink {
 public:
  JournalSink() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {}

 private:
  bool Write(spdlog::level::level_enum level, std::string_view line) override {
    datagram_.clear();
    Add("MESSAGE", line.substr(0, line.find_last_not_of('\n') + 1));
    Add("PRIORITY", level >= spdlog::level::err    ? "3"
                    : level >= spdlog::level::warn ? "4"
                    : level >= spdlog::level::info ? "6"
                                                   : "7");
    Add("SYSLOG_IDENTIFIER", "lpvmpcd");
    Add("LPVMPCD_MODE", fields_of_line.mode);
    Add("LPVMPCD_FAULT", fields_of_line.fault);
    Add("LPVMPCD_CAUSE", fields_of_line.cause);
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = "/run/systemd/journal/socket"};
    return ::sendto(socket_.get(), datagram_.data(), datagram_.size(), MSG_NOSIGNAL,
                    reinterpret_cast<const sockaddr*>(&address), sizeof(address)) >= 0;
  }

  // Binary-safe form of a field: name, newline, length as 64 bits little-endian, value, newline.
  void Add(std::string_view name, std::string_view value) {
    if (value.empty()) {
      return;
    }
    datagram_.append(name).append("\n");
    for (int shift = 0; shift < 64; shift += 8) {
      datagram_.push_back(static_cast<char>(value.size() >> shift & 0xFF));
    }
    datagram_.append(value).append("\n");
  }

  base::FileDescriptor socket_;
  std::string datagram_;
};

}  // namespace

void OpenLog(const std::string& level) {
  std::signal(SIGPIPE, SIG_IGN);
  const char* stream = std::getenv("JOURNAL_STREAM");
  std::shared_ptr<Sink> sink;
  if (stream != nullptr && IsJournal(STDERR_FILENO, stream)) {
    sink = std::make_shared<JournalSink>();
    sink->set_pattern("%v");
  } else {
    sink = std::make_shared<StderrSink>();
    sink->set_pattern("%H:%M:%S.%e %-7l %v");
  }
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("lpvmpcd", std::move(sink)));
  SetLogLevel(level);
}

void SetLogLevel(const std::string& level) {
  spdlog::default_logger_raw()->set_level(spdlog::level::from_str(level));
}

void SetLogFields(const LogFields& fields) {
  fields_of_line = fields;
}

bool IsJournal(int fd, std::string_view journal_stream) {
  struct stat status {};
  return ::fstat(fd, &status) == 0 && fmt::format("{}:{}", status.st_dev, status.st_ino) == journal_stream;
}

}  // namespace lpvmpcd
