#include "tools/report/read_sidecar.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/is_of.h"

namespace weir {
namespace {

// A histogram of 1,024 bins and two paths take some 50 KB; JSON takes up to 40 times its bytes in memory.
constexpr std::uintmax_t kMaxBytes = 4U << 20U;

// Whether there is no file of that name; all else says nothing of what the sidecar holds.
bool says_missing(const std::error_code& error) {
  return error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory ||
         error == std::errc::is_a_directory || error == std::errc::too_many_symbolic_link_levels ||
         error == std::errc::filename_too_long || error == std::errc::not_supported;  // the last: a pipe, a device
}

}  // namespace

Sidecar read_sidecar(const std::string& path) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) {
    const bool missing = says_missing(error);
    throw Error(missing ? ErrorKind::input : ErrorKind::io,
                cat(path, ": cannot read the sidecar: ", error.message(),
                    missing ? "; write it with weir convert, or look at the volume alone with weir inspect"
                            : "; check its disk or file server and the permissions, and try again"));
  }
  if (bytes > kMaxBytes) {
    throw Error(ErrorKind::input, cat(path, ": ", bytes, " bytes are no sidecar; write it again with weir convert"));
  }
  std::string text(bytes, '\0');
  std::ifstream in(path, std::ios::binary);
  if (!in.read(text.data(), static_cast<std::streamsize>(bytes))) {
    if (in.eof()) throw input_error(path, cat("has become shorter than ", bytes, " bytes while it was read"));
    throw Error(ErrorKind::io, path + ": cannot read the sidecar; check the permissions");
  }
  return parse_sidecar(text, path);
}

std::optional<Sidecar> own_sidecar(const NvdbFile& file) {
  const std::string path = find_sidecar(file.path());
  if (!is_there(path)) return std::nullopt;
  Sidecar sidecar = read_sidecar(path);
  return is_of(sidecar, file.grid()) ? std::optional(std::move(sidecar)) : std::nullopt;
}

}  // namespace weir
