// How a volume is cut into blocks that the memory ceiling holds. A pure
// function; results of a conversion never depend on it.
#pragma once

#include <cstdint>

#include "format/base/index.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// A regular cut of the leaf lattice of a domain: blocks of `leaves` leaves. The first ones are
/// smaller where the domain does not begin on a block boundary, the last ones where it ends between.
struct BlockPlan {
  NodeLattice lattice;            ///< leaves (dim 8) over the domain
  Index3 leaves;                  ///< leaves per block along each axis
  Index3 lead;                    ///< leaves of the first block that lie before the lattice, >= 0, < leaves
  Index3 count;                   ///< blocks along each axis
  std::uint64_t block_bytes = 0;  ///< float32 bytes of the largest block
  std::int64_t run_voxels = 0;    ///< contiguous voxels of the largest block in a row-major file
  double amplification = 1.0;     ///< chunk decodes / chunks: 1 where none is decoded twice

  std::int64_t size() const { return volume(count); }
  /// Leaves of block i as a half-open box of lattice positions; x fastest, then y, then z.
  Box leaf_box(std::int64_t i) const;
  /// In-domain voxels of a box of lattice positions, in index space.
  Box voxel_box(const Box& leaf_box) const;
};

/// Blocks grow no further than this once they are rows of whole lower nodes: reads are long enough
/// then, and several blocks let reading and work overlap.
inline constexpr std::uint64_t kAmpleBlockBytes = std::uint64_t{32} << 20U;

/// Blocks too small for a lower node's width in both axes are as long as possible in y, whose rows follow
/// each other in the input (wide), or in z, whose leaves follow each other in the output (deep).
enum class BlockShape { wide, deep };

/// Blocks whose float32 values fit `block_bytes`. Where rows are contiguous in the file: full rows in x,
/// whole rows of lower nodes (128 x 128 voxels in y and z, on multiples of 128 of the index) and, up to
/// kAmpleBlockBytes, more of them in y and then in z; otherwise fewer leaf layers in z, then fewer leaf
/// rows in y, and x is cut last. For chunked sources: whole chunks first, then as above; where that does
/// not fit, or chunk edges are off leaf edges, the cut that decodes the fewest chunks twice. A block is
/// never smaller than one leaf.
/// `domain` is not empty and its float32 bytes fit 63 bits. Throws Error(usage) where not even one leaf
/// fits.
BlockPlan plan_blocks(const Box& domain, const AccessShape& access, std::uint64_t block_bytes,
                      BlockShape shape = BlockShape::wide);

/// The fewest bytes, in whole MiB, with which plan_blocks decodes no chunk twice.
std::uint64_t bytes_for_whole_chunks(const Box& domain, const AccessShape& access);

}  // namespace weir
