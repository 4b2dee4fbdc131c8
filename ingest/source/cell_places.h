// Maps the voxels of a volume that is put together from cells of another volume to their places in that volume.
#pragma once

#include "format/base/index.h"
#include "format/leaf/bounds.h"

namespace weir {

/// The cells of such a volume. Each cell consists of whole leaves, and together they fill the volume. Thread-safe.
class CellPlaces {
 public:
  virtual ~CellPlaces() = default;

  /// Returns the cell that holds `voxel`: the voxels that were taken from one place of the other volume.
  virtual Box cell(const Index3& voxel) const = 0;
  /// Returns where `voxel` lies in the other volume.
  virtual Index3 origin_of(const Index3& voxel) const = 0;
  /// Returns the domain of the other volume.
  virtual Box origin_domain() const = 0;
  /// Returns the bounds of the finite values, in the other volume, of the leaf that holds `voxel` and of the leaves
  /// around it. Returns null if they are not known.
  virtual const MinMax* reach(const Index3& voxel) const = 0;
};

}  // namespace weir
