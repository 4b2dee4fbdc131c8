// Which files a viewer shows: one, the steps of a series, or those of a directory, and those they are compared with.
#pragma once

#include <string>
#include <vector>

#include "tools/options/volume_series.h"

namespace weir {

struct ViewedFiles {
  std::string title;                 ///< what was named, without its folders
  std::vector<std::string> steps;    ///< in natural order, one at least
  std::vector<std::string> against;  ///< none, one for all steps, or one for each
  SeriesSummary summary;             ///< of the steps
};

/// `input` is a NanoVDB file, a pattern or a directory, whose .nvdb files are taken; `against` likewise, or empty.
/// Nothing is opened but heads. Throws Error(input) where there is no such file, Error(usage) where `against` has
/// neither one file nor as many as there are steps, or a file is no NanoVDB file, with the command that makes it one.
ViewedFiles find_viewed_files(const std::string& input, const std::string& against);

}  // namespace weir
