// Parses the text of a legacy VTK file before and between its values:
// https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html, "Simple Legacy Formats".
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "format/base/scalar_type.h"
#include "ingest/vtk/vtk_array.h"
#include "ingest/vtk/vtk_image.h"

namespace weir {

struct VtkLegacyArray : VtkArray {
  std::uint64_t offset = 0;  ///< of the first value or, in text, of the first word, in the file
  /// COLOR_SCALARS as text: uint8 written as numbers from 0 to 1 (text_values.h).
  bool fractions = false;
};

struct VtkLegacyHeader {
  bool binary = false;  ///< big-endian values; else text
  VtkImage image;
  std::vector<VtkLegacyArray> arrays;
  std::optional<double> time;  ///< TimeValue of the field data, finite
};

/// Reads structured points from `in`, which stands at the first of `size` bytes, to its end. Skips values; skips text
/// values word by word. Throws Error(input), beginning with `path` and naming position, line or value, for other data
/// sets, for files that are no legacy VTK file, and for data beyond the file's end. An array that weir does not read
/// gets an `obstacle`.
VtkLegacyHeader parse_vtk_legacy_header(std::istream& in, std::uint64_t size, const std::string& path);

}  // namespace weir
