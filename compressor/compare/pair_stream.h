// Streams a volume and the decoded values of a file side by side, block by block.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "compressor/compare/compare.h"
#include "compressor/compare/value_pair.h"
#include "compressor/team/team.h"
#include "format/nanovdb/nvdb_grid.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Number of voxels around a block that are streamed with it, as far as the volume has them.
struct PairMargin {
  std::int64_t below = 0;
  std::int64_t above = 0;
};

/// Reads the volume in blocks with `margin` around each and decodes the same voxels of `grid`, which must have the
/// volume's box. Calls `visit(values, part)` for each block `part` of 8^3 voxels, cut to the volume, from several
/// threads at once. Each rank of `team` visits its own blocks. Three buffers of at most twice options.block_bytes
/// exist. Throws what reading and decoding throw, and Error(interrupted).
void stream_pairs(VolumeSource& source, const NvdbGrid& grid, const PairMargin& margin, const CompareOptions& options,
                  const std::function<void(const ValuePair&, const Box&)>& visit, const Team& team = no_team());

/// A volume and the file made from it.
struct PairedVolume {
  VolumeSource& source;
  const NvdbGrid& grid;
};

/// The same for several pairs, all over the domain of the first pair. `visit` gets the values of all pairs. Only the
/// blocks of the first pair are read ahead. There are three buffers for the first pair and two for each other pair.
void stream_pairs(std::span<const PairedVolume> volumes, const PairMargin& margin, const CompareOptions& options,
                  const std::function<void(std::span<const ValuePair>, const Box&)>& visit,
                  const Team& team = no_team());

}  // namespace weir
