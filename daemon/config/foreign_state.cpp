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

namespace fs = std::filesystem;

constexpr std::size_t kFirstPage = 4096;                         // bytes; SQLite's default page size
constexpr std::string_view kBeginning("SQLite format 3\0", 16);  // https://www.sqlite.org/fileformat.html, 1.3
constexpr std::size_t kVersionPlace = 60;                        // four bytes, big-endian
constexpr std::size_t kApplicationPlace = 68;                    // likewise
constexpr std::string_view kApplication("weir");
static_assert(kStateApplication == (('w' << 24) | ('e' << 16) | ('i' << 8) | 'r'));

std::int64_t version_on(std::string_view page) {
  std::int64_t version = 0;
  for (const char byte : page.substr(kVersionPlace, 4)) version = version << 8 | static_cast<unsigned char>(byte);
  return version;
}

// Refuses what SQLite could not make a database of.
void refuse_other_kinds(const std::string& path) {
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  if (type != fs::file_type::not_found && type != fs::file_type::regular && type != fs::file_type::none) {
    throw input_error(path, "is no regular file; name another file as state in [service]");
  }
  if (type != fs::file_type::not_found || !fs::is_symlink(path, error)) return;
  const fs::path target = (fs::path(path).parent_path() / fs::read_symlink(path, error)).lexically_normal();
  if (is_there(target.parent_path())) return;
  throw input_error(path, cat("is a link to ", target.string(), ", whose directory does not exist; make it or name ",
                              "another file as state in [service]"));
}

}  // namespace

Error newer_state(const std::string& path, std::int64_t version) {
  return input_error(path, cat("has version ", version, ", this weir knows versions up to ", kStateVersion,
                               "; run the newer weir or name another file as state in [service]"));
}

void refuse_foreign_state(const std::string& path) {
  refuse_other_kinds(path);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return;
  std::array<char, kFirstPage> room{};
  std::ifstream file(path, std::ios::binary);
  file.read(room.data(), room.size());
  const std::string_view page(room.data(), static_cast<std::size_t>(file.gcount()));
  const bool is_zero =
      std::ranges::all_of(page, [](char c) { return c == '\0'; });  // also true for an empty file, which is a new one
  if (is_zero || is_there(path + "-wal")) return;                   // the journal may hold another first page
  const bool is_ours = page.size() > kApplicationPlace && page.substr(kApplicationPlace).starts_with(kApplication);
  if (is_ours && page.starts_with(kBeginning) && version_on(page) > kStateVersion) {
    throw newer_state(path, version_on(page));
  }
  if (is_ours || page.starts_with(kBeginning)) return;
  throw Error(ErrorKind::input, cat(path, ": is no state file of weir; name another file as state in [service]"));
}

}  // namespace weir
