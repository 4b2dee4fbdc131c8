// What the smallest tree of a volume takes, as far as that is known without reading a value.
#pragma once

#include <cstdint>

#include "compressor/conversion_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Bytes of the smallest file that Selection allows, where all values are finite and the encoding is not packed; others
/// take that or more. Blocks some of whose voxels have no value (ValueMapping::gaps) are kept, and so are the first and
/// the last one.
std::uint64_t smallest_tree(const VolumeSource& source, const ConversionOptions& options);

/// Bytes in which a packed file without a preview has room for all of its regions and a value for each block.
std::uint64_t room_for_packed(const Box& domain);

}  // namespace weir
