// The bytes of a volume's smallest tree, as far as they are known without reading a value.
#pragma once

#include <cstdint>

#include "compressor/conversion_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns the bytes of the smallest file that Selection allows if all values are finite and the encoding is not
/// packed. Other volumes take at least these bytes. Blocks in which only some voxels have no value (ValueMapping::gaps)
/// are kept, and so are the first and the last block.
std::uint64_t smallest_tree(const VolumeSource& source, const ConversionOptions& options);

/// Returns the bytes at which a packed file without a preview has room for all its regions and for one value per block.
std::uint64_t room_for_packed(const Box& domain);

}  // namespace weir
