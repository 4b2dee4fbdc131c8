// Counts how the blocks of a packed grid are coded, from its directories and the first byte of each stream.
#pragma once

#include <array>
#include <cstdint>

#include "format/nanovdb/packed_data.h"

namespace weir {

struct PackedCensus {
  std::array<std::uint64_t, kPackedKinds> blocks{};  ///< blocks with a stream, by PackedKind
  std::array<std::uint64_t, kPackedKinds> bytes{};   ///< bytes of the streams, by PackedKind
  std::uint64_t none = 0;                            ///< blocks of 8^3 that touch the index box and have no stream
  std::uint64_t directory_bytes = 0;                 ///< all packed data except the streams

  std::uint64_t coded() const;
  /// Returns the bits per voxel of the streams of `kind`, without directories; 0 if there are none.
  double bits_a_voxel(PackedKind kind) const;
};

/// Counts every region, on all threads of TBB; decodes nothing. Throws as PackedData::stream.
PackedCensus take_packed_census(const PackedData& packed);

/// Returns "mean", "transform", "lattice" or "raw".
const char* packed_kind_name(PackedKind kind);

/// Returns the number of blocks of 8^3 that touch the index box.
std::uint64_t packed_block_count(const PackedData& packed);

}  // namespace weir
