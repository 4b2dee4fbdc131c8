// Shows a source through a temporary NanoVDB file: a quick packed conversion in a temporary directory, which is
// removed with the object.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "format/base/option_row.h"
#include "tools/report/progress.h"
#include "tools/view/base/temporary_folder.h"

namespace weir {

/// Returns whether `path` exists and is no NanoVDB file, so that it must be converted to be shown.
bool is_source(const std::string& path);

/// Returns the shell words with which weir render draws the source itself: "run.h5 --volume dense --dataset=/a".
/// `given` says how the source is read (input_options).
std::string dense_words(const std::string& source, const GivenOptions& given);

class SourcePreview {
 public:
  /// `eighth`: an eighth of the float32 size, to be looked at; `all`: lossless, to compare with.
  enum class Kept { eighth, all };
  /// Converts `source`, one volume, read as `given` says (input_options). The directory is made in `work_dir`, or in
  /// the directory for temporary files. `memory` is for the whole process. Throws as open_source and convert_volume,
  /// Error(interrupted) if interrupt_flag() is set.
  SourcePreview(const std::string& source, const GivenOptions& given, const std::string& work_dir,
                std::optional<std::uint64_t> memory, const ProgressOptions& shown, Kept kept = Kept::eighth);
  /// Returns the NanoVDB file, named after the source; a lossless file has the source's suffix before its own. Its
  /// sidecar lies beside it.
  std::string file() const { return file_.string(); }

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_;
};

}  // namespace weir
