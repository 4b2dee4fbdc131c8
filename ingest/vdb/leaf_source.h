// A volume that is kept as a sparse tree of 8^3 blocks, as in OpenVDB and NanoVDB files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "format/base/index.h"
#include "ingest/source/component_choice.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Reads blocks of one tree. For one thread, because a reader may remember its last position.
class LeafReader {
 public:
  virtual ~LeafReader() = default;
  /// Reads the kLeafVoxels stored values of the block at `origin` (multiples of kLeafDim), index x<<6 | y<<3 | z.
  /// Where the tree has no leaf, these are the value of the tile there, or the background.
  virtual void read(const Index3& origin, std::span<std::byte> values) = 0;
};

class LeafTree {
 public:
  virtual ~LeafTree() = default;
  /// Readers on several threads may work at the same time. The tree outlives them.
  virtual std::unique_ptr<LeafReader> reader() const = 0;
  virtual bool in_memory() const = 0;               ///< as VolumeSource::in_memory
  virtual std::uint64_t working_bytes() const = 0;  ///< as VolumeSource::working_bytes
  virtual std::uint64_t bytes_read() const = 0;     ///< as VolumeSource::bytes_read
};

/// Returns a source of `info`; the caller has filled in all its fields. `tree` holds values of info.type; for
/// vectors, the `components` of a voxel lie side by side.
std::unique_ptr<VolumeSource> make_leaf_source(std::unique_ptr<LeafTree> tree, SourceInfo info,
                                               const VoxelComponents& components = {});

}  // namespace weir
