// Errors of the operating system.
#pragma once

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace base {

// Returns `result`; if it is negative, throws std::runtime_error with the call's name and the text of errno.
inline int Checked(int result, const char* call) {
  if (result < 0) {
    throw std::runtime_error(std::string(call) + ": " + std::strerror(errno));
  }
  return result;
}

}  // namespace base
