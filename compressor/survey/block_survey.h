// Surveys blocks of a volume, in any order and from several threads. The blocks come from a pass over the volume, from
// a simulation or from several processes.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compressor/leaf/leaf_summary.h"
#include "compressor/packed/block_sample.h"
#include "compressor/packed/ladder_builder.h"
#include "compressor/survey/leaf_faces.h"
#include "compressor/survey/leaf_store.h"
#include "compressor/survey/row_store.h"
#include "compressor/survey/survey_figures.h"
#include "compressor/survey/survey_tally.h"
#include "format/base/trace.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Thread-safe except for tally().
class BlockSurvey {
 public:
  /// Who counts the values of a volume: the survey, block by block, or the caller, who passes the counts to
  /// add_counts().
  enum class Counting { here, elsewhere };
  /// `rows`, and `faces` if it is not null, receive the records of each leaf. They and `trace` must outlive the object.
  /// `widths` and `ladders` are as in SurveyTask.
  BlockSurvey(const SourceInfo& info, RowStore& rows, LeafStore<LeafFaces>* faces, bool widths, Trace* trace,
              const std::optional<LadderAim>& ladders = std::nullopt, Counting counting = Counting::here);

  /// Who surveys the leaves of a block: the calling thread alone, or TBB's workers too.
  enum class Sharing { alone, shared };
  /// Surveys all leaves of `leaf_box` (lattice positions). `block` holds their in-domain voxels. Add each leaf once.
  void add(const Block& block, const Box& leaf_box, Sharing sharing);

  /// Which leaves take() stores: all, or only those that are not in the sample.
  enum class Taken { all, unsampled };
  /// Stores the rows and ladders of the leaves in `parts`, boxes of one size, for which a device has `found` enough.
  /// Returns the numbers of the others of them, counted from part to part, x fastest in a part. Their rows and ladders
  /// are undefined until survey_left() is called for each leaf with its 512 values in leaf order, in any order and from
  /// several threads. Neither function counts values: call add_counts() for that.
  std::vector<std::uint32_t> take(const SurveyedBlocks& found, std::span<const Box> parts, Taken taken);
  void survey_left(const Index3& leaf, const float* block);
  /// Adds the counts of all finite values of a volume that a device holds.
  void add_counts(const RangeHistogram& histogram) { tallies_.local().histogram.merge(histogram); }

  /// Returns the tally of all blocks so far. No add() may be in progress.
  SurveyTally tally() const;

  /// Returns the survey that `tally` sums up. `tally` must cover the whole volume.
  Survey result(const SurveyTally& tally) const;

 private:
  // The smallest value and the number of values of an 8- or 16-bit integer type. The number is 0 if the values are
  // scaled, and for wider types.
  struct ValueTable {
    int offset = 0;
    std::size_t size = 0;
  };
  // The tally of one thread. A copy begins without a ladder builder.
  struct Tally : SurveyTally {
    Tally() = default;
    Tally(const Tally& other) : SurveyTally(other), uniform(other.uniform) {}
    Tally& operator=(const Tally&) = delete;
    UniformDigest uniform;
    LadderBuilder& builder(const LadderAim& aim) {
      if (!ladders) ladders = std::make_unique<LadderBuilder>(aim);
      return *ladders;
    }
    std::unique_ptr<LadderBuilder> ladders;  // made at first use
  };
  class Leaves;
  // Makes the row and the ladder of a leaf that lies wholly in the volume from what a device has found. Returns false
  // if that is not enough.
  bool take(const SurveyedBlock& found, const BlockSummary& summary, bool sampled, Tally& tally, LeafRow& row,
            PackedLadder& ladder) const;
  static ValueTable value_table(const SourceInfo& info);

  RowStore& rows_;
  LeafStore<LeafFaces>* faces_;
  bool widths_;
  std::optional<LadderAim> ladders_;
  BlockSample sample_;
  Counting counting_;
  bool has_missing_;  // whether the source has values that mean "no data"
  Trace* trace_;
  ValueTable table_;
  Tally fresh_;
  tbb::enumerable_thread_specific<Tally> tallies_;
};

}  // namespace weir
