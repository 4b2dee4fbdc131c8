#include "ingest/drivers/hdf5_signature.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "format/base/ascii.h"
#include "ingest/files/input_file.h"

namespace weir {
namespace {

constexpr std::string_view kSignature{"\x89HDF\r\n\x1a\n", 8};
constexpr std::uint64_t kFirstUserBlock = 512;

bool begins_with(std::span<const std::byte> bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
}

}  // namespace

bool has_hdf5_signature(const std::string& path) {
  InputFile file(path, DirectIo::off);
  std::array<std::byte, kSignature.size()> bytes{};
  for (std::uint64_t at = 0; at + bytes.size() <= file.size(); at = std::max(at * 2, kFirstUserBlock)) {
    file.read_buffered(at, bytes, ReadPath::through);
    if (begins_with(bytes, kSignature)) return true;
  }
  return false;
}

// A classic NetCDF file begins with "CDF" and the version of the format.
bool is_classic_netcdf(std::span<const std::byte> head) {
  return begins_with(head, {"CDF\1", 4}) || begins_with(head, {"CDF\2", 4}) || begins_with(head, {"CDF\5", 4});
}

bool recognises_hdf5(std::string_view path, std::span<const std::byte> head) {
  if (begins_with(head, kSignature) || is_classic_netcdf(head)) return true;
  return ends_with_one_of(path, kHdf5Endings) || has_hdf5_signature(std::string(path));
}

}  // namespace weir
