// What a scene can show of a volume: which values have an opacity (or touch its
// iso surface), in which region, and how much of an error in them can be seen.
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
    alike,      ///< all that can be seen counts the same: for a target, which is a promise
    by_picture  ///< by how far the picture can change with the value: for a size, which is to be spent well
  };

  /// `path` is the scene's file, for messages. Throws Error(usage) where the scene says nothing that decides
  /// (no opacity, iso or region), where its opacities have no range, and where its region lies outside `domain`.
  Visibility(const Scene& scene, const std::string& path, const Box& domain, Weighing weighing);

  /// Whether a lookup in the region can touch a voxel of `voxels`: filters reach one voxel far.
  bool in_region(const Box& voxels) const { return !intersect(grown(voxels, 1), region_).empty(); }
  /// Whether any value of the interval can be seen; false where it is empty.
  bool shows(const MinMax& values) const;
  /// Weight of a squared error in a value of the interval, from 0, which nobody can see. By picture: the square of
  /// the steepest slope of opacity and colour there, in parts of the scene's range; colours are taken to
  /// change by one over it.
  double weight(const MinMax& values) const;

 private:
  // The table's entries around the interval.
  struct Entries {
    std::size_t first;
    std::size_t last;
  };
  Entries entries_of(const MinMax& values) const;

  Weighing weighing_;
  Box region_;
  bool by_iso_ = false;
  float iso_ = 0;
  double low_ = 0;  // values of the table's ends
  double high_ = 0;
  // Of the scene's table, and the changes from each entry to the next; none: every value is seen alike.
  std::optional<RangeMax> opacity_;
  std::optional<RangeMax> steps_;
};

}  // namespace weir
