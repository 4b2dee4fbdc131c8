// A whole conversion in memory, and what a file of it must hold by its source.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "format/nanovdb/nvdb_grid.h"
#include "tests/compressor/support/memory_volume.h"

namespace weir::test {

struct Converted {
  Sidecar sidecar;
  std::vector<std::byte> file;
  std::vector<std::string> notices;
  int files_made = 0;  ///< the last one is kept; others missed what was asked

  NvdbGrid grid() const { return NvdbGrid::open(file, "out.nvdb"); }
};

/// Converts; options.output is ignored, and options.memory is made ample where it is the default.
Converted convert(VolumeSource& volume, ConversionOptions options);
Converted convert_to(VolumeSource& volume, ConversionOptions options, std::uint64_t file_bytes);
/// The size of the smallest tree, as the message for a budget of one byte gives it.
std::uint64_t minimum_size(VolumeSource& volume, ConversionOptions options);

/// Bits, for exact comparison with NaN and -0.0.
std::uint32_t bits_of(float value);

/// What a tile over `box` must hold: the mean of the finite in-domain values, computed in long double, or
/// the background.
float expected_tile(const MemoryVolume& volume, const Box& box, FillMode fill, float background);

}  // namespace weir::test
