#include "ingest/files/numbered_series.h"

#include <algorithm>
#include <filesystem>
#include <span>
#include <string_view>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/io/digest.h"
#include "ingest/files/file_pattern.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

// Replaces each number by a slash, which no file's name can contain.
std::string without_numbers(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (!is_digit(c)) {
      text += c;
    } else if (!text.ends_with('/')) {
      text += '/';
    }
  }
  return text;
}

}  // namespace

std::string series_key(const std::string& path) {
  const fs::path whole(path);
  return (whole.parent_path() / "").string() + without_numbers(whole.filename().string());
}

std::string series_digest(const std::string& path) {
  const std::string key = series_key(fs::absolute(path).lexically_normal().string());
  return piece_digest(std::as_bytes(std::span(key))).hex();
}

std::vector<std::string> files_of_series(const std::string& path) {
  const fs::path directory = fs::path(path).parent_path();
  const std::string wanted = without_numbers(fs::path(path).filename().string());
  std::vector<std::string> files;
  std::error_code error;
  fs::directory_iterator entry(directory.empty() ? "." : directory, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (without_numbers(name) == wanted) files.push_back((directory / name).string());
  }
  if (error) throw io_error(directory.empty() ? "." : directory.string(), "read the directory", error.value());
  std::sort(files.begin(), files.end(), natural_less);
  return files;
}

}  // namespace weir
