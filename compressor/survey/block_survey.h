// Surveys blocks that a pass over the volume, a simulation or several processes hand over, in any order and from
// several threads.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
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

/// Thread-safe but for tally().
class BlockSurvey {
 public:
  /// Who counts the values of a volume: the survey, as they come, or who has them all (add_counts()).
  enum class Counting { here, elsewhere };
  /// `rows` and, where not null, `faces` get what is kept of each leaf; all must outlive the object. `widths` and
  /// `ladders` as for survey_volume.
  BlockSurvey(const SourceInfo& info, RowStore& rows, LeafStore<LeafFaces>* faces, bool widths, Trace* trace,
              const std::optional<LadderAim>& ladders = std::nullopt, Counting counting = Counting::here);

  /// Who surveys the leaves of a block: the calling thread, or TBB's workers too.
  enum class Sharing { alone, shared };
  /// Surveys all leaves of `leaf_box` (lattice positions), whose in-domain voxels are those of `block`. Each leaf once.
  void add(const Block& block, const Box& leaf_box, Sharing sharing);

  /// Keeps what a device has found of the blocks of a box, where that is enough. Returns the positions in the box of
  /// the other leaves: their rows and ladders are undefined until survey_left() was called for each, with its 512
  /// values in leaf order; in any order, from several threads. Neither counts values: add_counts() does.
  std::vector<std::uint32_t> take(const SurveyedBlocks& found, const Box& leaf_box);
  void survey_left(const Index3& leaf, const float* block);
  /// Takes the counts of all finite values of a volume whose blocks a device has.
  void add_counts(const RangeHistogram& histogram) { tallies_.local().histogram.merge(histogram); }

  /// Of all blocks so far; no add may be in progress.
  SurveyTally tally() const;

  /// The survey that `tally`, of the whole volume, sums up.
  Survey result(const SurveyTally& tally) const;

 private:
  // Smallest value and number of values of an 8- or 16-bit integer type; zero values where they are scaled, and for
  // wider types.
  struct ValueTable {
    int offset = 0;
    std::size_t size = 0;
  };
  // What one thread has seen. Copies begin with no builder.
  struct Tally : SurveyTally {
    Tally() = default;
    Tally(const Tally& other) : SurveyTally(other), uniform(other.uniform) {}
    Tally& operator=(const Tally&) = delete;
    UniformDigest uniform;
    LadderBuilder& builder(const LadderAim& aim) {
      if (!ladders) ladders = std::make_unique<LadderBuilder>(aim);
      return *ladders;
    }
    std::unique_ptr<LadderBuilder> ladders;  // made where first needed
  };
  class Leaves;
  // A leaf that lies wholly in the volume, by what was found of it. False where that is not enough.
  bool take(const SurveyedBlock& found, const BlockSummary& summary, const Index3& leaf, Tally& tally, LeafRow& row,
            PackedLadder& ladder) const;
  static ValueTable value_table(const SourceInfo& info);

  RowStore& rows_;
  LeafStore<LeafFaces>* faces_;
  bool widths_;
  std::optional<LadderAim> ladders_;
  BlockSample sample_;
  Counting counting_;
  bool has_missing_;  // some values of the source stand for "no data"
  Trace* trace_;
  ValueTable table_;
  Tally fresh_;
  tbb::enumerable_thread_specific<Tally> tallies_;
};

}  // namespace weir
