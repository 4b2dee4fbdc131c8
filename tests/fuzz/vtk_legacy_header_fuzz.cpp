// libFuzzer target for legacy VTK files. Any bytes must parse to a header with arrays inside the file, or throw
// Error(input) with a message of one line.
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "format/base/error.h"
#include "ingest/vtk/vtk_legacy_header.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  try {
    const weir::VtkLegacyHeader header = weir::parse_vtk_legacy_header(in, size, "fuzz.vtk");
    for (const weir::VtkLegacyArray& array : header.arrays) {
      if (!array.obstacle.empty()) continue;
      const auto values = static_cast<std::uint64_t>(weir::volume(weir::vtk_extent(header.image, array.cells)));
      const std::uint64_t bytes = header.binary ? values * weir::scalar_bytes(array.type) : 2 * values - 1;
      if (array.offset > size || bytes > size - array.offset) std::abort();
    }
  } catch (const weir::Error& error) {
    const std::string_view message = error.what();
    if (error.kind() != weir::ErrorKind::input || message.find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
