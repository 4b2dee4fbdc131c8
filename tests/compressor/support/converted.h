// Whole conversions in memory, and the values that their files must hold according to the source.
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
  int files_made = 0;  ///< the last one is in `file`; the others missed the target

  NvdbGrid grid() const { return NvdbGrid::open(file, "out.nvdb"); }
};

/// Converts `volume`. Ignores options.output. If options.memory is the default, gives the conversion ample memory.
Converted convert(VolumeSource& volume, ConversionOptions options);
Converted convert_to(VolumeSource& volume, ConversionOptions options, std::uint64_t file_bytes);
/// Returns the size of the smallest tree, from the error message for a budget of one byte.
std::uint64_t minimum_size(VolumeSource& volume, ConversionOptions options);

/// Returns the bits of a float, for exact comparison with NaN and -0.0.
std::uint32_t bits_of(float value);

/// Returns the value that a tile over `box` must hold: the mean of the finite in-domain values, computed in long
/// double, or the background.
float expected_tile(const MemoryVolume& volume, const Box& box, FillMode fill, float background);

}  // namespace weir::test
