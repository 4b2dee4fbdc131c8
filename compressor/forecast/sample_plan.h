// The places of a volume that a forecast samples: cells of whole leaves, one drawn from each of many equal parts of the
// volume. Put side by side in the order of these parts, the cells form a volume of their own. Neighbours in this volume
// come from places near each other.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compressor/forecast/sample_axis.h"
#include "format/base/index.h"
#include "ingest/source/volume_source.h"

namespace weir {

class SamplePlan {
 public:
  /// Samples all of `domain` if it has up to twice `most_voxels`, because a sample and its parts() take as long.
  /// Otherwise samples at most `most_voxels`, as far as the cells allow: rows of up to 4096 voxels, or whole chunks. A
  /// sample of large chunks may have a twentieth of the volume if fewer than kLeastPlaces of them would fit otherwise.
  /// `brick` is the number of leaves along an axis that selection takes as one.
  SamplePlan(const Box& domain, const AccessShape& access, std::int64_t most_voxels, std::int64_t brick);

  static constexpr std::int64_t kLeastPlaces = 32;

  /// Returns whether the sample is the whole volume, unchanged.
  bool whole() const;
  /// Returns the domain of the sample as a volume. Along an axis that is taken whole it is the volume's own domain.
  /// Along other axes it begins at 0.
  Box domain() const;
  /// Returns the number of cells. There is one for each part of the volume.
  std::int64_t places() const { return volume(counts()); }
  /// Returns the number of cells along each axis; 1 along an axis that is taken whole.
  Index3 counts() const;
  /// Returns the voxels of a cell along each axis; the whole axis if it is taken whole.
  Index3 cell() const;

  /// Returns the access shape of the sample, given the volume's. If the volume has chunks, the cells are the sample's
  /// chunks.
  AccessShape access(AccessShape of_volume) const;

  /// box() returns the box of the sample that the cell at `place` fills. source_corner() returns the cell's lowest
  /// voxel in the volume.
  Box box(const Index3& place) const;
  Index3 source_corner(const Index3& place) const;
  /// For a part of a sample: returns the lowest voxel of the same cell in the sample.
  Index3 sample_corner(const Index3& place) const;

  /// Returns 8 or 4 parts of the sample, or none if it has fewer than 16 places. Each part is spread over the whole
  /// volume, as the sample is.
  std::vector<SamplePlan> parts() const;

 private:
  std::int64_t count(std::size_t axis) const;
  std::array<std::int64_t, 3> strata_of(const Index3& place) const;
  void limit(std::int64_t most_voxels);

  std::array<SampleAxis, 3> axes_;
  std::array<std::int64_t, 3> stride_{1, 1, 1};  // distance between the strata of a part
  std::array<std::int64_t, 3> offset_{0, 0, 0};  // first stratum of a part
};

}  // namespace weir
