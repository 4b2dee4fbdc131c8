// Where the voxels of a volume that is put together from cells of another one lie there.
#pragma once

#include "format/base/index.h"
#include "format/leaf/bounds.h"

namespace weir {

/// Cells are of whole leaves, and fill the volume. Thread-safe.
class CellPlaces {
 public:
  virtual ~CellPlaces() = default;

  /// Voxels of the volume that were taken from one place of the other one: those of the cell that holds `voxel`.
  virtual Box cell(const Index3& voxel) const = 0;
  /// Where `voxel` lies in the other volume.
  virtual Index3 origin_of(const Index3& voxel) const = 0;
  /// Of the other volume.
  virtual Box origin_domain() const = 0;
  /// Bounds of the finite values of the leaf that holds `voxel` and of those around it in the other volume; null where
  /// they are not known.
  virtual const MinMax* reach(const Index3& voxel) const = 0;
};

}  // namespace weir
