// The TOML example in the comment that begins a header: what its manual shows has to be a file that is accepted.
#pragma once

#include <fstream>
#include <stdexcept>
#include <string>

namespace test_support {

// The lines "//   ..." before `#pragma once` of a header, by its path from the root, without the slashes.
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
