// Which files a viewer shows: one, the steps of a series, or those of a directory, and those they are compared with.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/view/steps/series_heads.h"

namespace weir {

/// What names the steps, so that it can be asked again: more may have come.
struct StepChoice {
  std::string input;    ///< a NanoVDB file, a pattern or a directory, whose .nvdb files are taken
  bool series = false;  ///< the file's series: files_of_series
};

/// The steps that there are now, in natural order, one at least. Opens no file. Throws Error(input) where there is
/// none, Error(io) where they cannot be looked for, Error(usage) where one is no NanoVDB file, with the command that
/// makes it one.
std::vector<std::string> find_steps(const StepChoice& choice);

struct ViewedFiles {
  std::string title;                 ///< what was named, without its folders
  std::string key;                   ///< the same text for what is the same, and for nothing else; tells no path
  std::vector<std::string> steps;    ///< what a page shows at first, then the others in natural order
  std::vector<std::string> against;  ///< none, one for all steps, or one for each
  SeriesHeads heads;                 ///< of the steps
  StepChoice choice{};
  bool grow = false;  ///< more steps may come: `choice` names no single file, and `against` not one for each

  /// All steps have one range of values and one background; else a file has its own.
  bool series() const { return steps.size() > 1 || grow; }
};

/// How many volumes are held at a time: VoxelMemory::volumes.
std::size_t volumes_held(const ViewedFiles& files);

/// ViewedFiles::key of what is named so.
std::string viewed_key(const StepChoice& choice, const std::string& against);

/// `against` is a file, a pattern or a directory, or empty. Nothing is opened but heads. Throws as find_steps, and
/// Error(usage) where `against` has neither one file nor as many as there are steps.
ViewedFiles find_viewed_files(const StepChoice& choice, const std::string& against);

/// Puts the first step that can be read before the others, with the file that it is compared with where each has its
/// own, and returns why those that were before it cannot be. Throws as NvdbFile where none can, where the first one was
/// named, or where the one file of `against` cannot be read.
std::vector<std::string> begin_with_readable(ViewedFiles& files);

/// Whether what a page shows at first and what that is compared with have other index boxes, voxel sizes or origins.
/// Reads their heads; one that cannot be read is like any other.
bool lies_elsewhere(const ViewedFiles& files);

}  // namespace weir
