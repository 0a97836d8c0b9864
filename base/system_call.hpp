// Errors of the operating system.
#pragma once

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace base {

// `result`, unless it is that of a failed call: then throws std::runtime_error with the call's name and errno's text.
inline int Checked(int result, const char* call) {
  if (result < 0) {
    throw std::runtime_error(std::string(call) + ": " + std::strerror(errno));
  }
  return result;
}

}  // namespace base
