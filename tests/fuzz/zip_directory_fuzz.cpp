// libFuzzer target for the directory of a zip file. Any bytes must parse to entries inside the file, or throw Error
// with a message of one line. The parser must not read outside the file.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "format/base/error.h"
#include "ingest/zarr/store/zip_directory.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const weir::ZipBytes file{size, [&](std::uint64_t offset, std::span<std::byte> into) {
                              if (offset > size || into.size() > size - offset) std::abort();
                              std::copy_n(reinterpret_cast<const std::byte*>(data) + offset, into.size(), into.begin());
                            }};
  const auto check_line = [](const weir::Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  };
  try {
    for (const auto& [name, entry] : weir::read_zip_directory(file, 1 << 20U, "fuzz")) {
      if (name.empty() || name.back() == '/') std::abort();
      try {
        const std::uint64_t begin = weir::zip_entry_begin(file, name, entry, "fuzz");
        if (begin > size || entry.packed > size - begin) std::abort();
      } catch (const weir::Error& error) {
        check_line(error);
      }
    }
  } catch (const weir::Error& error) {
    check_line(error);
  }
  return 0;
}
