#include "format/base/error.h"
#include "ingest/zarr/codecs/library_codecs.h"

namespace weir {

bool has_library_codecs() { return false; }

std::size_t unpack_zstd(std::span<const std::byte>, std::span<std::byte>) {
  throw Error(ErrorKind::internal, "zstd: this build has no decoder of it");
}

std::size_t unpack_blosc(std::span<const std::byte>, std::span<std::byte>) {
  throw Error(ErrorKind::internal, "blosc: this build has no decoder of it");
}

}  // namespace weir
