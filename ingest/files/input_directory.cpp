#include "ingest/files/input_directory.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>

namespace weir {

std::optional<std::string> head_in_directory(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return std::nullopt;
  for (const char* const head : kDirectoryHeads) {
    const std::filesystem::path file = std::filesystem::path(path) / head;
    if (std::filesystem::is_regular_file(file, ignored)) return file.string();
  }
  return std::nullopt;
}

std::string_view named_by_head(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string_view::npos || slash == 0) return path;
  const std::string_view name = path.substr(slash + 1);
  return std::find(kDirectoryHeads.begin(), kDirectoryHeads.end(), name) == kDirectoryHeads.end()
             ? path
             : path.substr(0, slash);
}

bool is_plotfile_head(std::string_view path) {
  return is_head(path) && path.substr(path.rfind('/') + 1) == kDirectoryHead;
}

std::string without_last_slash(const std::string& path) {
  const std::size_t end = path.find_last_not_of('/');
  if (path.empty() || end + 1 == path.size() || end == std::string::npos || !is_input_directory(path)) return path;
  return path.substr(0, end + 1);
}

}  // namespace weir
