// What a legacy VTK file says before and between its values:
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

/// Reads structured points from `in`, which stands at the first of `size` bytes, to its end; values are skipped, those
/// in text by their words. Throws Error(input), beginning with `path`, naming position, line or value, for other data
/// sets, what is no such file and what reaches beyond its end. Of an array that weir does not read, that is in its
/// `obstacle`.
VtkLegacyHeader parse_vtk_legacy_header(std::istream& in, std::uint64_t size, const std::string& path);

}  // namespace weir
