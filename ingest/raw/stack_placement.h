// Where the planes of a stack's files lie, by what each file says of itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ingest/source/volume_source.h"

namespace weir {

/// The planes of one file of a stack, as they are read.
struct StackedPlanes {
  std::string path;
  std::int64_t count = 0;
  double first = 0;                 ///< world position of the first one; of a file that does not place itself 0
  double spacing = 1;               ///< between them; of a single one what its format takes for none
  std::vector<double> coordinates;  ///< where they are not equally spaced; else empty
  bool placed = true;               ///< the members above say where they lie
  bool reversed = false;            ///< they are read in the other order than the file has them in
};

/// World position of the first voxel along `axis`, 0 to 2.
double first_position(const SourceInfo& info, std::size_t axis);

StackedPlanes stacked_planes(const std::string& path, const SourceInfo& info);

/// Throws Error(input) where columns and rows of `info` lie elsewhere than those of `first`, or mean something else, or
/// are of another time.
void check_placed_alike(const std::string& path, const SourceInfo& info, const SourceInfo& first);

/// Whether the files follow each other from the last to the first, since the planes of each are read in reverse order,
/// or, with `by_position`, since single planes fall by equal steps. Throws Error(input) where some files are reversed
/// and others are not.
bool stacked_backwards(const std::vector<StackedPlanes>& files, bool by_position);

/// Sets spacing, origin and what the sidecar says of the z axis of `info`, by the planes of all files in the order of
/// the stack, which is `backwards` or not. Where all begin at one place, or one does not say where it lies, they stay
/// what the first file says; where the planes are not equally spaced, the spacing stays. Throws Error(input) where the
/// planes of the files neither rise nor fall.
void place_planes(const std::vector<StackedPlanes>& files, bool backwards, SourceInfo& info);

}  // namespace weir
