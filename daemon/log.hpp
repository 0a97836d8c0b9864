// The log goes to the journal if stderr is connected to it, otherwise to stderr. Neither makes the control path wait: a
// line is dropped if its reader is stalled and has no room for it, and the number of dropped lines is logged as soon as
// there is room again.
#pragma once

#include <string>
#include <string_view>

namespace lpvmpcd {

// `level`: "debug", "info", "warning" or "error". SIGPIPE is ignored: a reader that goes away ends the log, not the
// daemon.
void OpenLog(const std::string& level);
void SetLogLevel(const std::string& level);

// State at the time of a line, written as journal fields for queries such as `journalctl LPVMPCD_MODE=SafeStop`. The
// texts must remain valid until they are replaced; an empty one is omitted.
struct LogFields {
  std::string_view mode;   // LPVMPCD_MODE
  std::string_view fault;  // LPVMPCD_FAULT
  std::string_view cause;  // LPVMPCD_CAUSE, of the mode
};
void SetLogFields(const LogFields& fields);

// True if `fd` is the file that JOURNAL_STREAM identifies (DEVICE:INODE, see systemd.exec(5)).
[[nodiscard]] bool IsJournal(int fd, std::string_view journal_stream);

}  // namespace lpvmpcd
