// NanoVDB on disk, ABI 32: sizes and field offsets in bytes, little endian. Names follow NanoVDB.h of 10.0.1 (stamp
// 32.4.2); FORMAT.md has diagrams.
#pragma once

#include <cstdint>

namespace weir::nvdb {

inline constexpr std::uint64_t kMagic = 0x304244566f6e614eULL;          ///< "NanoVDB0"
inline constexpr std::uint32_t kVersion = 32U << 21U | 4U << 10U | 2U;  ///< 32.4.2
inline constexpr std::uint32_t kMajorVersion = 32;
inline constexpr std::uint64_t kNoChecksum = ~std::uint64_t{0};
inline constexpr std::uint64_t kAlignment = 32;  ///< alignment of every node
inline constexpr std::uint64_t kPage = 4096;     ///< the grid's offset in the file is a multiple of it

inline constexpr std::uint64_t kFileHeaderBytes = 16;
inline constexpr std::uint64_t kFileMetaBytes = 176;
inline constexpr std::uint64_t kNameOffset = kFileHeaderBytes + kFileMetaBytes;

inline constexpr std::uint64_t kGridBytes = 672;
inline constexpr std::uint64_t kTreeBytes = 64;
inline constexpr std::uint64_t kRootBytes = 64;
inline constexpr std::uint64_t kRootTileBytes = 32;
inline constexpr std::uint64_t kUpperBytes = 270400;
inline constexpr std::uint64_t kLowerBytes = 33856;
inline constexpr std::uint64_t kFloatLeafBytes = 2144;
inline constexpr std::uint64_t kLeafHeadBytes = 96;
inline constexpr std::uint64_t kBlindMetaBytes = 288;

inline constexpr std::uint64_t kTreeOffset = kGridBytes;  ///< from the grid's start
inline constexpr std::uint64_t kRootOffset = kTreeOffset + kTreeBytes;
inline constexpr std::uint64_t kRootTilesOffset = kRootOffset + kRootBytes;

/// File meta data, offsets from the file's start (kFileHeaderBytes already added).
namespace meta {
inline constexpr std::uint64_t kGridSize = 16, kFileSize = 24, kNameKey = 32, kVoxelCount = 40, kGridType = 48,
                               kGridClass = 52, kWorldBBox = 56, kIndexBBox = 104, kVoxelSize = 128, kNameSize = 152,
                               kNodeCount = 156, kTileCount = 172, kCodec = 184, kBlindCount = 186, kVersion = 188;
}

/// GridData, offsets from the grid's start.
namespace grid {
inline constexpr std::uint64_t kMagic = 0, kChecksum = 8, kVersion = 16, kFlags = 20, kGridIndex = 24, kGridCount = 28,
                               kGridSize = 32, kName = 40, kMap = 296, kWorldBBox = 560, kVoxelSize = 608,
                               kGridClass = 632, kGridType = 636, kBlindOffset = 640, kBlindCount = 648;
inline constexpr std::uint64_t kNameBytes = 256;
inline constexpr std::uint32_t kFlagBBox = 2, kFlagMinMax = 4, kFlagAverage = 8, kFlagStdDev = 16,
                               kFlagBreadthFirst = 32;
}  // namespace grid

/// TreeData, offsets from TreeData.
namespace tree {
inline constexpr std::uint64_t kLeafOffset = 0, kLowerOffset = 8, kUpperOffset = 16, kRootOffset = 24, kNodeCount = 32,
                               kTileCount = 44, kVoxelCount = 56;
}

/// RootData and its tiles, offsets from the root or the tile.
namespace root {
inline constexpr std::uint64_t kBBox = 0, kTableSize = 24, kBackground = 28, kMin = 32, kMax = 36, kAverage = 40,
                               kStdDev = 44;
inline constexpr std::uint64_t kTileKey = 0, kTileChild = 8, kTileState = 16, kTileValue = 20;
}  // namespace root

/// Internal nodes: N entries, offsets from the node.
struct InternalLayout {
  std::uint64_t entries, value_mask, child_mask, min, max, average, stddev, table, bytes;
};
inline constexpr std::uint64_t kNodeBBox = 0, kNodeFlags = 24;
inline constexpr InternalLayout kUpper{32768, 32, 4128, 8224, 8228, 8232, 8236, 8256, kUpperBytes};
inline constexpr InternalLayout kLower{4096, 32, 544, 1056, 1060, 1064, 1068, 1088, kLowerBytes};

/// Leaves, offsets from the leaf.
namespace leaf {
inline constexpr std::uint64_t kBBoxMin = 0, kBBoxDim = 12, kFlags = 15, kValueMask = 16, kMin = 80, kMax = 84,
                               kAverage = 88, kStdDev = 92, kValues = 96;
inline constexpr std::uint64_t kQuantMinimum = 80, kQuantum = 84, kQuantMin = 88, kQuantMax = 90, kQuantAverage = 92,
                               kQuantStdDev = 94, kCodes = 96;  ///< quantised leaves
}  // namespace leaf

/// Blind data record, offsets from the record.
namespace blind {
inline constexpr std::uint64_t kDataOffset = 0, kCount = 8, kElementSize = 16, kSemantic = 20, kClass = 24, kType = 28,
                               kName = 32;
inline constexpr std::uint64_t kNameBytes = 256;
}  // namespace blind

}  // namespace weir::nvdb
