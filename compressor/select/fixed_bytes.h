// The bytes of a file that are not bought for its blocks: the part of a budget that is spent before selection.
#pragma once

#include <cstdint>

#include "compressor/leaf/encoding.h"
#include "compressor/select/preview.h"
#include "format/base/index.h"

namespace weir {

/// Returns the number of regions of 128^3 voxels that overlap `domain`.
std::uint64_t region_count(const Box& domain);

/// Returns the bytes of a file over `domain` with all upper nodes and `regions` lower nodes open and nothing else kept:
/// head, tree and macrocells, and for a packed file also its tables and its regions' directories. With
/// Preview::automatic, a packed file has a preview if that is a small part of `asked` bytes.
std::uint64_t fixed_bytes(const Box& domain, Encoding encoding, Preview preview, std::uint64_t asked,
                          std::uint64_t regions);

}  // namespace weir
