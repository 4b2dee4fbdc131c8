// libFuzzer target for NRRD headers. Any bytes must parse to a header with consistent parts, or throw Error(input) with
// a message of one line.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "format/base/error.h"
#include "ingest/nrrd/nrrd_header.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  for (const bool whole : {false, true}) {
    try {
      const weir::NrrdHeader header = weir::parse_nrrd_header(input, whole, "fuzz.nrrd");
      const auto fits = [&](const auto& of_axes) { return of_axes.empty() || of_axes.size() == header.sizes.size(); };
      if (header.sizes.empty() || header.header_bytes > size || !fits(header.kinds) || !fits(header.labels) ||
          !fits(header.spacings) || !fits(header.axis_mins) || !fits(header.axis_maxs) || !fits(header.centerings) ||
          !fits(header.directions)) {
        std::abort();
      }
    } catch (const weir::Error& error) {
      const std::string_view message = error.what();
      if (error.kind() != weir::ErrorKind::input || message.find('\n') != std::string_view::npos) std::abort();
    }
  }
  return 0;
}
