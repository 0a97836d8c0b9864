#include "tools/io/progress_bar.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <unistd.h>

namespace tools {

ProgressBar::ProgressBar(std::size_t total)
    : total_(std::max<std::size_t>(total, 1)), on_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (on_terminal_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::Name(const std::string& name) {
  name_ = name;
  Draw();
}

void ProgressBar::Advance() {
  done_ = std::min(done_ + 1, total_);
  Draw();
}

void ProgressBar::Draw() const {
  if (!on_terminal_) return;
  constexpr std::size_t kWidth = 30;
  const std::size_t filled = kWidth * done_ / total_;
  const std::string line = fmt::format("\r[{:#<{}}{:.<{}}] {:3} %  {}\033[K", "", filled, "", kWidth - filled,
                                       100 * done_ / total_, name_);
  std::fputs(line.c_str(), stderr);
}

}  // namespace tools
