#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "config/text_file.hpp"
#include "tools/commands/command.hpp"
#include "tools/commands/decode.hpp"

namespace tools {
namespace {

int Decode(const std::string& log) {
  if (log != "-") {
    std::ifstream file = config::OpenTextFile(log);
    return RunDecode(file, log, std::cout, std::cerr);
  }
  const int status = RunDecode(std::cin, "standard input", std::cout, std::cerr);
  // std::cin does not distinguish a read error from the end of its input.
  if (std::ferror(stdin) != 0) throw std::runtime_error("standard input: cannot be read");
  return status;
}

}  // namespace

Command AddDecode(CLI::App& program) {
  const auto log = std::make_shared<std::string>("-");
  CLI::App* command = program.add_subcommand("decode", "decode candump text to physical values");
  command->add_option("LOG", *log, "candump log; - for standard input")->capture_default_str();
  return {.app = command, .run = [log] { return Decode(*log); }};
}

}  // namespace tools
