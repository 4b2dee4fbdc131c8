#include "format/sidecar/read_sidecar.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"
#include "format/io/refused_open.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/is_of.h"

namespace weir {
Sidecar read_sidecar(const std::string& path) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) {
    const bool missing = is_fault_of_name(error.value()) || error == std::errc::not_supported;  // a pipe, a device
    throw Error(missing ? ErrorKind::input : ErrorKind::io,
                cat(path, ": cannot read the sidecar: ", error.message(),
                    missing ? "; write it with weir convert, or look at the volume alone with weir inspect"
                            : "; check its disk or file server and the permissions, and try again"));
  }
  if (bytes > kMostSidecarBytes) {
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
  return is_of(sidecar, file) ? std::optional(std::move(sidecar)) : std::nullopt;
}

}  // namespace weir
