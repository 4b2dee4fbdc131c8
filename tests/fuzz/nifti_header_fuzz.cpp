// libFuzzer target for NIfTI headers. Any bytes must parse to a header within the format's limits, or throw
// Error(input) with a message of one line.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "format/base/error.h"
#include "ingest/nifti/nifti_header.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const weir::NiftiHeader header = weir::parse_nifti_header(std::as_bytes(std::span(data, size)), "fuzz.nii");
    const auto& extents = header.extents;
    if (extents.empty() || extents.size() > 7 || *std::min_element(extents.begin(), extents.end()) < 1 ||
        header.values_offset > std::uint64_t{1} << 62U || header.slope == 0 || !std::isfinite(header.intercept)) {
      std::abort();
    }
    for (const double spacing : header.spacing) {
      if (!(spacing > 0) || !std::isfinite(spacing)) std::abort();
    }
  } catch (const weir::Error& error) {
    const std::string_view message = error.what();
    if (error.kind() != weir::ErrorKind::input || message.find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
