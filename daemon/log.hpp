// Where the lines of the log go: to the journal if stderr is connected to it, otherwise to stderr. Neither makes the
// control path wait: a line that a stalled reader has no room for is dropped, and the next one that gets through says how
// many were.
#pragma once

#include <string>
#include <string_view>

namespace lpvmpcd {

// `level`: "debug", "info", "warning" or "error". A reader that goes away ends the log, not the daemon: SIGPIPE is
// ignored.
void OpenLog(const std::string& level);
void SetLogLevel(const std::string& level);

// What is so while a line is written, as fields of the journal for `journalctl LPVMPCD_MODE=SafeStop` and the like. The
// texts must stay where they are; an empty one is left out.
struct LogFields {
  std::string_view mode;   // LPVMPCD_MODE
  std::string_view fault;  // LPVMPCD_FAULT
  std::string_view cause;  // LPVMPCD_CAUSE, of the mode
};
void SetLogFields(const LogFields& fields);

// True if this file descriptor is what JOURNAL_STREAM, DEVICE:INODE as in systemd.exec(5), tells.
[[nodiscard]] bool IsJournal(int fd, std::string_view journal_stream);

}  // namespace lpvmpcd
