// From the survey to one planned file: selection under the budget for each
// encoding that may be used, and the choice between them.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "compressor/packed/ladder_window.h"
#include "compressor/resume/work_directory.h"
#include "compressor/select/file_size.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/leaf_gain.h"
#include "compressor/select/packed_region.h"
#include "compressor/select/preview.h"
#include "compressor/select/tree_plan.h"
#include "compressor/select/tree_regions.h"
#include "compressor/survey/row_store.h"
#include "format/base/error.h"
#include "format/packed/block_constants.h"
#include "format/packed/lattice_block.h"

namespace weir {

/// What a packed file is made with.
struct PackedRequest {
  Preview preview = Preview::automatic;
  BlockConstants constants;        ///< but for `coarsest`, its tables outlive the file
  std::optional<Lattice> lattice;  ///< of the whole volume
  /// Ladders have the rungs that cuts within it can choose; none: all rungs.
  std::optional<KeyWindow> window{};
};

/// A file, planned to its last offset.
struct FilePlan {
  Encoding encoding = Encoding::float32;
  Fill fill;
  std::unique_ptr<TreeRegions> tree;
  std::unique_ptr<ChoiceStore> choices;
  std::optional<PackedRule> packed;                ///< of a packed file
  std::unique_ptr<PlannedStreamsStore> streams{};  ///< of a packed file
  FileSize size;
  std::optional<double> cut{};  ///< the key at which buying ended; none where all was bought, or only what is required
  TreePlan plan;                ///< its layout is padded to the size
  /// Of a quantised file that was chosen by the error expected: the squared error of the float file it was chosen over,
  /// which is exact. Infinite where there is none.
  double float_error = std::numeric_limits<double>::infinity();
  bool float_error_is_bound = false;  ///< the float file was not planned: it loses that or more
};

struct FileRequest {
  Encoding encoding = Encoding::float32;  ///< automatic: whichever of float32 and fpn has less error
  GainRule rule;                          ///< but for its encoding
  Budget budget;
  double squared_error = 0;  ///< for a PSNR: what the sum over the finite voxels that can be seen may come to
  /// For a PSNR: the error to plan quantised leaves and packed blocks for, since theirs is estimated. At first a little
  /// less than squared_error, then adjusted by what their files lose. Float leaves are planned for squared_error.
  double planned_error = std::numeric_limits<double>::infinity();
  bool adjusted = false;  ///< planned_error was, by what a file lost
  PackedRequest packed;   ///< for Encoding::packed
  Box domain;
  bool keeps_non_finite = false;  ///< some voxels stay NaN or infinite, which only float32 holds
  bool pads_file = true;          ///< to the size of the budget, where all is chosen
  bool plans_float = false;       ///< for Encoding::automatic: the float file, too, where a bound would do
  std::string path;               ///< of the output, for messages
};

/// Plans the file for a surveyed volume: of the asked size with the least error, or of the least size with the
/// asked error. What a quantised file loses is estimated: Encoding::automatic means that where it turns out to lose
/// more than `float_error`, the float file is to be taken; if that is a bound, after a plan with `plans_float` says so.
/// Throws Error(budget) where size, error or exactness cannot be met, naming what can, Error(usage) where the encoding
/// cannot hold the volume. Where planned_error was adjusted and this encoding is not expected to reach it, the plan is
/// all that it has.
FilePlan plan_file(const FileRequest& request, const RowStore& rows, WorkDirectory& work);

/// Error(budget) for a target that `encoding` misses, where for a PSNR all it has loses `squared_error`.
Error unmet_target(const FileRequest& request, Encoding encoding, double squared_error);

}  // namespace weir
