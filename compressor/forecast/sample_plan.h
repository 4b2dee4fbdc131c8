// Which places of a volume a forecast looks at: cells of whole leaves, one drawn from each of many equal parts of the
// volume. Put side by side in the order of these parts they are a volume of their own, in which neighbours come from
// near each other.
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
  /// All of `domain` where it has up to twice `most_voxels`, since a sample and its parts() take as long. Else at most
  /// `most_voxels`, as far as its cells let it: rows of up to 4096 voxels, or whole chunks. Cells of large chunks may
  /// come to a twentieth of the volume, where it takes that for kLeastPlaces of them. `brick`: leaves that selection
  /// takes as one.
  SamplePlan(const Box& domain, const AccessShape& access, std::int64_t most_voxels, std::int64_t brick);

  static constexpr std::int64_t kLeastPlaces = 32;

  /// All of the volume, as it is.
  bool whole() const;
  /// Of the sample as a volume. Along an axis that is whole it is the volume's own, along others it begins at 0.
  Box domain() const;
  /// Cells, one from each part of the volume.
  std::int64_t places() const { return volume(counts()); }
  /// Along each axis; 1 where it is whole.
  Index3 counts() const;
  /// Voxels of a cell: along an axis that is whole all of it.
  Index3 cell() const;

  /// How the sample is read where the volume is read like that: its cells are its chunks, if that has any.
  AccessShape access(AccessShape of_volume) const;

  /// The box of the sample that the cell at that place fills, and where it lies in the volume.
  Box box(const Index3& place) const;
  Index3 source_corner(const Index3& place) const;
  /// Of a part: where the same cell lies in the sample.
  Index3 sample_corner(const Index3& place) const;

  /// Parts of the sample, each of which is spread over the whole volume as it is: 8, or 4; none of fewer than 16
  /// places.
  std::vector<SamplePlan> parts() const;

 private:
  std::int64_t count(std::size_t axis) const;
  std::array<std::int64_t, 3> strata_of(const Index3& place) const;
  void limit(std::int64_t most_voxels);

  std::array<SampleAxis, 3> axes_;
  std::array<std::int64_t, 3> stride_{1, 1, 1};  // between strata of a part
  std::array<std::int64_t, 3> offset_{0, 0, 0};  // of its first one
};

}  // namespace weir
