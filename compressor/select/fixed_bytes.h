// What a file takes besides what is bought for its blocks: the part of a budget that is spent before selection.
#pragma once

#include <cstdint>

#include "compressor/leaf/encoding.h"
#include "compressor/select/preview.h"
#include "format/base/index.h"

namespace weir {

/// Regions of 128^3 voxels that a domain has a part in.
std::uint64_t region_count(const Box& domain);

/// Bytes of a file over `domain` in which all upper nodes and `regions` lower ones are open and nothing else is kept:
/// head, tree, macrocells, of a packed one also its tables and its regions' directories. With Preview::automatic a
/// packed file of `asked` bytes, which has a preview where that is a small part of it.
std::uint64_t fixed_bytes(const Box& domain, Encoding encoding, Preview preview, std::uint64_t asked,
                          std::uint64_t regions);

}  // namespace weir
