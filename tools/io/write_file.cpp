#include "tools/io/write_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

namespace tools {

namespace fs = std::filesystem;

void WriteFile(const fs::path& file, std::string_view text) {
  std::error_code error;
  const fs::path target = fs::weakly_canonical(file, error);
  const bool replaced = !fs::exists(target, error) || fs::is_regular_file(target, error);
  fs::path written = target;
  if (replaced) written += ".unfinished";
  const auto fail = [&](const std::string& reason) {
    if (replaced) fs::remove(written, error);
    return std::runtime_error(file.string() + ": cannot be written: " + reason);
  };
  errno = 0;
  std::ofstream out(written, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw fail(std::strerror(errno));
  if (!replaced) return;
  std::error_code renaming;
  fs::rename(written, target, renaming);
  if (renaming) throw fail(renaming.message());
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": cannot be created: " + error.message());
}

}  // namespace tools
