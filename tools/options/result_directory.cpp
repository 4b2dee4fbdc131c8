#include "tools/options/result_directory.h"

#include <algorithm>
#include <filesystem>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

std::string without_last_slashes(std::string path) {
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  return path;
}

// Returns `path` and its parents that do not exist, `path` first.
std::vector<std::string> missing_levels(FileSystem& files, std::filesystem::path path) {
  std::vector<std::string> levels;
  while (!path.empty() && !files.exists(path.string())) {
    levels.push_back(path.string());
    path = without_last_slashes(path.parent_path().string());
  }
  if (!path.empty() && !std::filesystem::is_directory(path)) {
    throw usage_error(cat(path.string(), ": is no directory; choose another one with -o"));
  }
  return levels;
}

}  // namespace

ResultDirectory::ResultDirectory(FileSystem& files, const std::string& path)
    : files_(files), path_(without_last_slashes(path)) {
  if (path == "-") throw usage_error("-: a directory is to be made, and - means standard output; name it ./- or else");
  std::vector<std::string> levels = missing_levels(files, path_);
  std::ranges::reverse(levels);
  try {
    for (const std::string& level : levels) {
      files_.make_directory(level);
      made_.push_back(level);
    }
  } catch (const Error&) {
    remove_empty();
    throw;
  }
}

ResultDirectory::~ResultDirectory() { remove_empty(); }

void ResultDirectory::remove_empty() noexcept {
  try {
    while (!made_.empty()) {
      files_.remove_directory(made_.back());
      made_.pop_back();
    }
  } catch (const Error&) {  // not empty: the usual case
  }
}

std::string ResultDirectory::operator/(const std::string& name) const {
  return (std::filesystem::path(path_) / name).string();
}

}  // namespace weir
