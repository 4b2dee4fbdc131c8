// What a scene can show of a volume: which values have an opacity (or touch the iso surface), in which region, and how
// much of an error in these values can be seen.
#pragma once

#include <optional>
#include <string>

#include "format/base/index.h"
#include "format/leaf/bounds.h"
#include "format/nanovdb/range_max.h"
#include "format/sidecar/scene.h"

namespace weir {

class Visibility {
 public:
  enum class Weighing {
    alike,      ///< everything visible counts the same; for an error target, which is a promise
    by_picture  ///< by how much the picture can change with the value; for a size, to spend the bytes well
  };

  /// `path` is the scene's file, for messages. Throws Error(usage) if the scene has no opacity, iso value or region to
  /// decide by, if its opacities have no range, or if its region lies outside `domain`.
  Visibility(const Scene& scene, const std::string& path, const Box& domain, Weighing weighing);

  /// Returns whether a lookup in the region can touch a voxel of `voxels`. Filters reach one voxel far.
  bool in_region(const Box& voxels) const { return !intersect(grown(voxels, 1), region_).empty(); }
  /// Returns whether any value of the interval can be seen; false if the interval is empty.
  bool shows(const MinMax& values) const;
  /// Returns the weight of a squared error in a value of the interval. 0 means that nobody can see the error. With
  /// by_picture, the weight is the square of the steepest slope of opacity plus colour in the interval, per range of
  /// the scene. Colours are assumed to change by one over that range.
  double weight(const MinMax& values) const;

 private:
  // The first and the last entry of the opacity table around an interval of values.
  struct Entries {
    std::size_t first;
    std::size_t last;
  };
  Entries entries_of(const MinMax& values) const;

  Weighing weighing_;
  Box region_;
  bool by_iso_ = false;
  float iso_ = 0;
  double low_ = 0;  // values at the two ends of the table
  double high_ = 0;
  // Maxima over the scene's opacity table, and over the changes from each entry to the next. Unset: the scene's opacity
  // does not tell values apart.
  std::optional<RangeMax> opacity_;
  std::optional<RangeMax> steps_;
};

}  // namespace weir
