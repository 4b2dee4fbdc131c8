// Plans one file from the survey: runs the selection under the budget for each encoding that may be used, and chooses
// between the encodings.
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

/// The parameters of a packed file.
struct PackedRequest {
  Preview preview = Preview::automatic;
  BlockConstants constants;        ///< but for `coarsest`, its tables outlive the file
  std::optional<Lattice> lattice;  ///< of the whole volume
  /// The window of keys for which ladders were built: they have the rungs that cuts within it can choose. nullopt: all
  /// rungs.
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
  std::optional<double> cut{};  ///< key at which buying ended; nullopt if all or only required steps were bought
  TreePlan plan;                ///< its layout is padded to the size
  /// For a quantised file that was chosen by its expected error: the exact squared error of the float file that was not
  /// chosen. Infinite if there is no such file.
  double float_error = std::numeric_limits<double>::infinity();
  bool float_error_is_bound = false;  ///< the float file was not planned and loses at least `float_error`
};

struct FileRequest {
  Encoding encoding = Encoding::float32;  ///< automatic: whichever of float32 and fpn has less error
  GainRule rule;                          ///< its encoding is ignored
  Budget budget;
  double squared_error = 0;  ///< for a PSNR: the most that the sum over the finite, visible voxels may be
  /// For a PSNR: the squared error for which quantised leaves and packed blocks are planned, because their error is
  /// only estimated. At first a little less than squared_error, then adjusted by the error of the encoded file. Float
  /// leaves are planned for squared_error.
  double planned_error = std::numeric_limits<double>::infinity();
  bool adjusted = false;  ///< planned_error was adjusted by the error of an encoded file
  PackedRequest packed;   ///< for Encoding::packed
  Box domain;
  bool keeps_non_finite = false;  ///< some voxels stay NaN or infinite, which fp4, fp8, fp16 and fpn cannot hold
  bool pads_file = true;          ///< pads the file to the budget's size
  bool plans_float = false;       ///< for Encoding::automatic: plans the float file even if a bound would do
  std::string path;               ///< of the output, for messages
};

/// Plans the file for a surveyed volume: the least error at the asked size, or the least size with the asked error.
/// The error of a quantised file is estimated. With Encoding::automatic, if the encoded file loses more than
/// `float_error`, the caller takes the float file; if `float_error` is a bound, the caller first plans with
/// `plans_float`. Throws Error(budget) that names what is possible if size, error or exactness cannot be met, and
/// Error(usage) if the encoding cannot hold the volume. If planned_error was adjusted and this encoding is not expected
/// to reach it, the plan is the best that the encoding has.
FilePlan plan_file(const FileRequest& request, const RowStore& rows, WorkDirectory& work);

/// Returns the error for a target that `encoding` misses: Error(budget), or Error(internal) for packed. For a PSNR,
/// `squared_error` is the encoding's least error.
Error unmet_target(const FileRequest& request, Encoding encoding, double squared_error);

}  // namespace weir
