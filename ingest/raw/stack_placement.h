// Computes where the planes of a stack lie, from what each of its files says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ingest/source/volume_source.h"

namespace weir {

/// The planes of one file of a stack, in the order that they are read in.
struct StackedPlanes {
  std::string path;
  std::int64_t count = 0;
  double first = 0;                 ///< world position of the first plane; 0 for a file that does not place itself
  double spacing = 1;               ///< distance of the planes; for a single plane, the default of its format
  std::vector<double> coordinates;  ///< positions of the planes if they are not equally spaced; else empty
  bool placed = true;               ///< the members above give the positions
  bool reversed = false;            ///< the planes are read in reverse of the file's order
};

/// Returns the world position of the first voxel along `axis`, 0 to 2.
double first_position(const SourceInfo& info, std::size_t axis);

StackedPlanes stacked_planes(const std::string& path, const SourceInfo& info);

/// Throws Error(input) if the columns and rows of `info` lie elsewhere than those of `first` or mean something else,
/// or if the times differ.
void check_placed_alike(const std::string& path, const SourceInfo& info, const SourceInfo& first);

/// Returns whether the files follow each other from the last to the first. This is so if the planes of each file are
/// read in reverse order, or, with `by_position`, if files of one plane each fall by equal steps. Throws Error(input)
/// if some files are reversed and others are not.
bool stacked_backwards(const std::vector<StackedPlanes>& files, bool by_position);

/// Sets the spacing, origin and sidecar details of the z axis of `info` from the planes of all files, in the order of
/// the stack; `backwards` says whether this order is reversed. If all files begin at one position, or a file has no
/// position, the values of the first file stay. If the planes are not equally spaced, the spacing stays. Throws
/// Error(input) if the planes neither rise nor fall throughout.
void place_planes(const std::vector<StackedPlanes>& files, bool backwards, SourceInfo& info);

}  // namespace weir
