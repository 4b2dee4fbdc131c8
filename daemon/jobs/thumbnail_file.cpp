#include "daemon/jobs/thumbnail_file.h"

#include <filesystem>
#include <fstream>
#include <string_view>

namespace weir {
namespace {

constexpr std::uintmax_t kMaxBytes = 8 << 20;
constexpr std::string_view kPngMagic = "\x89PNG\r\n\x1a\n";

}  // namespace

std::optional<std::string> read_thumbnail(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(path, error))) return std::nullopt;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error || bytes > kMaxBytes) return std::nullopt;
  std::string content(bytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(content.data(), static_cast<std::streamsize>(bytes));
  if (!file || !content.starts_with(kPngMagic)) return std::nullopt;
  return content;
}

}  // namespace weir
