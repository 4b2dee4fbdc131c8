#include "ingest/files/input_directory.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <utility>

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

namespace {

// Returns what an irregular file is. Returns "" for a regular file, for a directory called Header, and if nothing is
// there.
std::string irregular_what(const std::filesystem::path& file) {
  const auto no_file = [](const std::string& kind) {
    return "is " + kind + " and not a regular file; copy its content to one";
  };
  std::error_code ignored;
  switch (std::filesystem::status(file, ignored).type()) {
    case std::filesystem::file_type::fifo:
      return no_file("a pipe");
    case std::filesystem::file_type::socket:
      return no_file("a socket");
    case std::filesystem::file_type::block:
    case std::filesystem::file_type::character:
      return no_file("a device");
    case std::filesystem::file_type::directory:
      return file.filename() == kDirectoryHead ? "" : "is a directory and not a file; copy the array again";
    case std::filesystem::file_type::not_found:
      return std::filesystem::is_symlink(file, ignored)
                 ? "is a link to a file that is not there; fetch that file, or remove the link"
                 : "";
    default:
      return "";
  }
}

}  // namespace

std::optional<IrregularHead> irregular_head(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return std::nullopt;
  for (const char* const head : kDirectoryHeads) {
    const std::filesystem::path file = std::filesystem::path(path) / head;
    std::string what = irregular_what(file);
    if (!what.empty()) return IrregularHead{file.string(), std::move(what)};
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
