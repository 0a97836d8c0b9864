// The TOML example in the comment at the top of a header, for tests that the documented file is accepted.
#pragma once

#include <fstream>
#include <stdexcept>
#include <string>

namespace test_support {

// Returns the lines "//   ..." before `#pragma once`, without the slashes. `header`: path from the root. Throws
// std::runtime_error if the file cannot be read.
inline std::string ExampleOf(const std::string& header) {
  std::ifstream file(LPVMPC_SOURCE_DIR "/" + header);
  if (!file) throw std::runtime_error("cannot read " + header);
  std::string example;
  for (std::string line; std::getline(file, line) && line != "#pragma once";) {
    if (line.starts_with("//   ")) example += line.substr(5) + '\n';
  }
  return example;
}

}  // namespace test_support
