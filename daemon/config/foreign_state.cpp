#include "daemon/config/foreign_state.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"

namespace weir {
namespace {

constexpr std::size_t kFirstPage = 4096;                         // bytes; SQLite's default page size
constexpr std::string_view kBeginning("SQLite format 3\0", 16);  // https://www.sqlite.org/fileformat.html, 1.3
constexpr std::size_t kApplicationPlace = 68;                    // four bytes, big-endian
constexpr std::string_view kApplication("weir");
static_assert(kStateApplication == (('w' << 24) | ('e' << 16) | ('i' << 8) | 'r'));

}  // namespace

void refuse_foreign_state(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return;
  std::array<char, kFirstPage> room{};
  std::ifstream file(path, std::ios::binary);
  file.read(room.data(), room.size());
  const std::string_view page(room.data(), static_cast<std::size_t>(file.gcount()));
  const bool is_zero =
      std::ranges::all_of(page, [](char c) { return c == '\0'; });  // also true for an empty file, which is a new one
  if (is_zero || page.starts_with(kBeginning) || is_there(path + "-wal")) return;
  if (page.size() > kApplicationPlace && page.substr(kApplicationPlace).starts_with(kApplication)) return;
  throw Error(ErrorKind::input, cat(path, ": is no state file of weir; name another file as state in [service]"));
}

}  // namespace weir
