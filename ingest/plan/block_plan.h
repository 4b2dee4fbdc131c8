// Cuts a volume into blocks that fit the memory ceiling. A pure function; results of a conversion never depend on the
// cut.
#pragma once

#include <cstdint>

#include "format/base/index.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// A regular cut of the leaf lattice of a domain into blocks of `leaves` leaves. The first blocks are smaller if the
/// domain does not begin on a block boundary. The last ones are smaller if it does not end on one.
struct BlockPlan {
  NodeLattice lattice;            ///< leaves (dim 8) over the domain
  Index3 leaves;                  ///< leaves per block along each axis
  Index3 lead;                    ///< leaves of the first block that lie before the lattice; >= 0, < leaves
  Index3 count;                   ///< blocks along each axis
  std::uint64_t block_bytes = 0;  ///< float32 bytes of the largest block
  std::int64_t run_voxels = 0;    ///< contiguous voxels of the largest block in a row-major file
  double amplification = 1.0;     ///< chunk decodes / chunks; 1 if no chunk is decoded twice

  std::int64_t size() const { return volume(count); }
  /// Returns the leaves of block i as a half-open box of lattice positions; x fastest, then y, then z.
  Box leaf_box(std::int64_t i) const;
  /// Returns the in-domain voxels of a box of lattice positions, in index space.
  Box voxel_box(const Box& leaf_box) const;
};

/// Once blocks are rows of whole lower nodes, they grow no further than this many bytes: reads are long enough then,
/// and several blocks let reading and work overlap.
inline constexpr std::uint64_t kAmpleBlockBytes = std::uint64_t{32} << 20U;

/// The shape of blocks that cannot have a lower node's width in both y and z. Wide blocks are as long as possible in
/// y, because rows along y follow each other in the input. Deep blocks are as long as possible in z, because leaves
/// along z follow each other in the output.
enum class BlockShape { wide, deep };

/// Returns blocks with float32 values that fit `block_bytes`. If rows are contiguous in the file: full rows in x,
/// whole rows of lower nodes (128 x 128 voxels in y and z, on multiples of 128 of the index) and, up to
/// kAmpleBlockBytes, more of them in y and then in z. If these do not fit: fewer leaf layers in z, then fewer leaf
/// rows in y, and x is cut last. For chunked sources: whole chunks first, then as above; if whole chunks do not fit,
/// or chunk edges are off leaf edges, the cut that decodes the fewest chunks twice. A block is never smaller than one
/// leaf. `domain` is not empty and its float32 bytes fit 63 bits. Throws Error(usage) if not even one leaf fits.
BlockPlan plan_blocks(const Box& domain, const AccessShape& access, std::uint64_t block_bytes,
                      BlockShape shape = BlockShape::wide);

/// Returns the fewest bytes, in whole MiB, with which plan_blocks decodes no chunk twice.
std::uint64_t bytes_for_whole_chunks(const Box& domain, const AccessShape& access);

}  // namespace weir
