// The files that a viewer shows (one file, the steps of a series, or the files of a directory) and the files they are
// compared with.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/view/steps/series_heads.h"

namespace weir {

/// The input that names the steps, kept so that it can be searched again for new steps.
struct StepChoice {
  std::string input;    ///< a NanoVDB file, a pattern or a directory, whose .nvdb files are taken
  bool series = false;  ///< take the file's series: files_of_series
};

/// Returns the present steps in natural order, at least one. Opens no file. Throws Error(input) if there is none,
/// Error(io) if the directory cannot be read, Error(usage) if a step is no NanoVDB file, with the command that
/// converts it.
std::vector<std::string> find_steps(const StepChoice& choice);

struct ViewedFiles {
  std::string title;                 ///< the named input, without its folders
  std::string key;                   ///< the same text for the same input and for no other; reveals no path
  std::vector<std::string> steps;    ///< the step that a page shows first, then the others in natural order
  std::vector<std::string> against;  ///< files to compare with: none, one for all steps, or one for each
  SeriesHeads heads;                 ///< heads of the steps
  StepChoice choice{};
  bool grow = false;  ///< more steps may come: `choice` names no single file, and `against` not one for each

  /// Returns whether all steps share one range of values and one background; otherwise each file has its own.
  bool series() const { return steps.size() > 1 || grow; }
};

/// Returns how many volumes are held at a time: VoxelMemory::volumes.
std::size_t volumes_held(const ViewedFiles& files);

/// Returns ViewedFiles::key for these inputs.
std::string viewed_key(const StepChoice& choice, const std::string& against);

/// Finds the files to show. `against` is a file, a pattern or a directory, or empty. Only heads are opened. Throws as
/// find_steps, and Error(usage) if `against` has neither one file nor as many files as there are steps.
ViewedFiles find_viewed_files(const StepChoice& choice, const std::string& against);

/// Moves the first readable step to the front, together with its own comparison file if each step has one. Returns why
/// the steps before it cannot be read. Throws as NvdbFile if no step can be read, if the first step was named by the
/// user, or if the single file of `against` cannot be read.
std::vector<std::string> begin_with_readable(ViewedFiles& files);

/// Returns whether the step shown first and its comparison file differ in index box, voxel size or origin. Reads their
/// heads; an unreadable file counts as equal.
bool lies_elsewhere(const ViewedFiles& files);

}  // namespace weir
