// A line on a terminal that shows the progress of a long command; silent if stderr is not a terminal.
#pragma once

#include <cstddef>
#include <string>

namespace tools {

class ProgressBar {
 public:
  explicit ProgressBar(std::size_t total);
  ~ProgressBar();  // wipes the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // Names the current work, shown from now on.
  void Name(const std::string& name);
  // Counts one of `total` as done.
  void Advance();

 private:
  void Draw() const;

  std::size_t total_;
  std::size_t done_ = 0;
  bool on_terminal_;
  std::string name_;
};

}  // namespace tools
