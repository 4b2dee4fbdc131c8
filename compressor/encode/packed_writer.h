// Writes the packed data except the streams and their ends: the header, the tables, the region table, and the part of
// each chunk that comes before its groups.
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

/// Writes the entry of a region without a chunk to the region table: all its blocks read `value`.
void write_empty_region(const TreeLayout& layout, std::int64_t region, float value, File& out);

/// Writes the entry of region `index` to the region table, and the head of its chunk if it has streams. `regions` is
/// the number of regions.
void write_directory(const TreeLayout& layout, std::size_t regions, std::int64_t index, const Region& region,
                     const StreamPlaces& places, File& out);

}  // namespace weir
