// Writes packed data but for the streams and their ends: header, tables, region table, and of each chunk what comes
// before its groups.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compressor/encode/layer_encoder.h"
#include "compressor/select/packed_region.h"
#include "compressor/select/tree_regions.h"
#include "format/io/file_system.h"
#include "format/layout/tree_layout.h"

namespace weir {

void write_packed_head(const PackedTarget& packed, const TreeRegions& tree, const TreeLayout& layout, File& out);

/// The region's entry in the region table: no chunk, all blocks read `value`.
void write_empty_region(const TreeLayout& layout, std::int64_t region, float value, File& out);

/// The entry of a region with streams, one of `regions`, and the head of its chunk.
void write_directory(const TreeLayout& layout, std::size_t regions, std::int64_t index, const Region& region,
                     const StreamPlaces& places, File& out);

}  // namespace weir
