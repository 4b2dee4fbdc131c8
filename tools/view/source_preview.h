// A source as a NanoVDB file for the time that somebody looks at it: a quick packed conversion in a directory of its
// own, which goes with the object.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "format/base/option_row.h"
#include "tools/report/progress.h"
#include "tools/view/base/temporary_folder.h"

namespace weir {

/// Whether `path` is no NanoVDB file, but there, so that it has to be converted to be seen.
bool is_source(const std::string& path);

/// "run.h5 --volume dense --dataset=/a": what weir render draws the source itself by, as words of a shell. `given` says
/// how it is read (input_options).
std::string dense_words(const std::string& source, const GivenOptions& given);

class SourcePreview {
 public:
  /// An eighth of its float32 size, to be looked at; or without loss, to compare with.
  enum class Kept { eighth, all };
  /// Converts `source`, one volume, read as `given` says (input_options). The directory is made in `work_dir`, or where
  /// temporary files are. `memory` is of the whole process. Throws as open_source and convert_volume,
  /// Error(interrupted) where interrupt_flag() was set.
  SourcePreview(const std::string& source, const GivenOptions& given, const std::string& work_dir,
                std::optional<std::uint64_t> memory, const ProgressOptions& shown, Kept kept = Kept::eighth);
  /// The NanoVDB file, named after the source, one without loss with its suffix before its own; its sidecar lies beside
  /// it.
  std::string file() const { return file_.string(); }

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_;
};

}  // namespace weir
