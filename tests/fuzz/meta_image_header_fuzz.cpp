// libFuzzer target for MetaImage headers. Any bytes must parse to a header with consistent parts, or throw Error(input)
// with a message of one line.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "format/base/error.h"
#include "ingest/meta_image/meta_image_header.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  for (const bool whole : {false, true}) {
    try {
      const weir::MetaImageHeader header = weir::parse_meta_image_header(input, whole, "fuzz.mha");
      const std::size_t axes = header.dim_size.size();
      const auto fits = [](const auto& values, std::size_t count) { return values.empty() || values.size() == count; };
      if (axes == 0 || header.header_bytes > size || !fits(header.spacing, axes) || !fits(header.origin, axes) ||
          !fits(header.transform, axes * axes) || header.slope == 0 || !std::isfinite(header.slope)) {
        std::abort();
      }
    } catch (const weir::Error& error) {
      const std::string_view message = error.what();
      if (error.kind() != weir::ErrorKind::input || message.find('\n') != std::string_view::npos) std::abort();
    }
  }
  return 0;
}
