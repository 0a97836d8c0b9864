// A line on a terminal that tells how far a long command has come; silent where stderr is no terminal.
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

  // What is worked on from now on.
  void Name(const std::string& name);
  // One of `total` is done.
  void Advance();

 private:
  void Draw() const;

  std::size_t total_;
  std::size_t done_ = 0;
  bool on_terminal_;
  std::string name_;
};

}  // namespace tools
