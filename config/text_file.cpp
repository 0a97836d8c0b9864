#include "config/text_file.hpp"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <iterator>
#include <system_error>

#include "config/toml_table.hpp"

namespace config {

namespace {

ConfigError Unreadable(const std::filesystem::path& file, int error) {
  return ConfigError(fmt::format("{}: cannot be read: {}", PlaceName(file), std::strerror(error)));
}

}  // namespace

std::ifstream OpenTextFile(const std::filesystem::path& file) {
  std::error_code unused;
  if (std::filesystem::is_directory(file, unused)) throw Unreadable(file, EISDIR);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Unreadable(file, errno);
  return stream;
}

std::string ReadTextFile(const std::filesystem::path& file) {
  std::ifstream stream = OpenTextFile(file);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) throw Unreadable(file, EIO);
  return text;
}

std::string Printable(std::string_view text, std::size_t longest) {
  std::string out;
  for (const char c : text.substr(0, longest)) out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  if (text.size() > longest) out += "...";
  return out;
}

std::string PlaceName(const std::filesystem::path& file) {
  return Printable(file.string(), std::string_view::npos);
}

}  // namespace config
