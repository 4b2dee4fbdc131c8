// Packed data on disk, version 1: sizes and field offsets in bytes, little endian. FORMAT.md describes it in full.
#pragma once

#include <cstdint>

#include "format/packed/block_constants.h"

namespace weir::packed {

/// Name of the blind data record; the number is the version.
inline constexpr char kRecordName[] = "weir_packed:1";
inline constexpr std::uint32_t kVersion = 1;

/// Header, offsets from the packed data's first byte.
namespace header {
inline constexpr std::uint64_t kBytes = 0, kVersion = 8, kFlags = 12, kFirstRegion = 16, kRegionCount = 28,
                               kMinimum = 40, kMaximum = 44, kCoarsest = 48, kLatticeMinimum = 52, kLatticeQuantum = 56,
                               kLatticeBits = 60, kBelowOne = 64, kBelowMore = 68, kTables = 72, kTableCount = 76,
                               kRegions = 80;
inline constexpr std::uint32_t kFlagPreview = 1;
}  // namespace header

inline constexpr std::uint64_t kHeaderBytes = 96;
inline constexpr std::uint64_t kTablesBytes = std::uint64_t{kPackedTables} * kPackedSymbols * 2;
inline constexpr std::uint64_t kRegionsOffset = kHeaderBytes + kTablesBytes;
static_assert(kRegionsOffset % 8 == 0);

/// An entry of the region table, offsets from the entry.
namespace region {
inline constexpr std::uint64_t kChunk = 0, kValue = 8, kChunkBytes = 12;
inline constexpr std::uint64_t kEntryBytes = 16;
}  // namespace region

/// Returns the offset of the first chunk, behind the table of `regions` regions.
constexpr std::uint64_t chunks_offset(std::uint64_t regions) { return kRegionsOffset + regions * region::kEntryBytes; }

/// A region's chunk, offsets from the chunk.
namespace chunk {
inline constexpr std::uint64_t kMeanLow = 0, kMeanHigh = 4, kBases = 8, kMasks = 1036, kGroups = 1548;
inline constexpr std::uint64_t kGroupCount = 256, kGroupBlocks = 16;
inline constexpr std::uint64_t kEndBytes = 2;  ///< bytes of the directory for each stream
inline constexpr std::uint64_t kAlignment = 4;
}  // namespace chunk

}  // namespace weir::packed
