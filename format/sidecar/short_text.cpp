#include "format/sidecar/short_text.h"

#include <cstdint>
#include <span>

#include "format/base/error.h"
#include "format/sidecar/sidecar.h"

namespace weir {

std::string short_text(File& file) {
  const std::uint64_t bytes = file.size();
  if (bytes > kMostSidecarBytes) throw Error(ErrorKind::input, file.path() + ": is no sidecar");
  std::string text(bytes, '\0');
  file.read_at(0, std::as_writable_bytes(std::span(text)));
  return text;
}

std::string short_text(FileSystem& files, const std::string& path) { return short_text(*files.open_to_read(path)); }

}  // namespace weir
