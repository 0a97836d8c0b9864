// The message of the exception that a call throws.
#pragma once

#include <exception>
#include <string>

namespace test_support {

template <typename Call>
std::string ErrorOf(const Call& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace test_support
