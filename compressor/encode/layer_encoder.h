// The interface of encoders: the encode pass hands them blocks, one layer at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "compressor/encode/leaf_record.h"
#include "compressor/leaf/fill.h"
#include "compressor/leaf/quantised_leaf.h"
#include "compressor/resume/encoded_state.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/packed_region.h"
#include "compressor/select/tree_regions.h"
#include "compressor/survey/row_store.h"
#include "compressor/survey/surveyed_leaves.h"
#include "format/base/trace.h"
#include "format/io/file_system.h"
#include "format/layout/nvdb_type.h"
#include "format/layout/tree_layout.h"
#include "format/packed/block_coder.h"
#include "format/packed/block_constants.h"
#include "format/packed/lattice_block.h"
#include "ingest/plan/block_stream.h"

namespace weir {

/// The settings with which packed blocks are encoded.
struct PackedTarget {
  const PlannedStreamsStore& streams;
  PackedRule rule;
  BlockConstants constants;
  std::optional<Lattice> lattice;   ///< lattice of the whole volume's values, if known
  std::optional<double> max_error;  ///< the error bound, if the budget has one
  BlockCoder* coder = nullptr;      ///< encodes many blocks at a time; may be null
};

/// Takes the records of a region after all of them are made. Thread-safe for different regions.
class RegionSink {
 public:
  RegionSink() = default;
  virtual ~RegionSink() = default;
  RegionSink(const RegionSink&) = delete;
  RegionSink& operator=(const RegionSink&) = delete;

  /// `records` are the records of the region's kept leaves, at least one, in the order of the leaves.
  virtual void take(std::int64_t region, std::span<const LeafRecord> records) = 0;
};

struct EncodeTarget {
  const TreeRegions& tree;
  const ChoiceStore& choices;
  const TreeLayout& layout;
  Fill fill;
  GridType type;  ///< float32 or quantised
  Fit fit;        ///< how quantised leaves are fitted
  File& out;
  RecordStore* records;  ///< null if `regions` takes the records
  const RowStore& rows;  ///< of the survey; each rank of its team encodes the leaves of its own regions
  Trace* trace = nullptr;
  const PackedTarget* packed = nullptr;  ///< set if blocks are packed; `type` and `fit` then have no meaning
  bool sums = true;                      ///< whether LayerEncoder::sums() will be called, for a journal
  RegionSink* regions = nullptr;         ///< for a volume on a device: takes the records instead of `records`
};

/// The places of a region's kept blocks in the file. Exactly one of the members is set.
struct RegionPlaces {
  std::optional<LeafPlaces> leaves;
  std::optional<StreamPlaces> streams;  ///< for packed blocks
};

inline RegionPlaces places_of(const EncodeTarget& target, std::int64_t region) {
  RegionPlaces places;
  if (target.packed != nullptr) {
    places.streams.emplace(target.packed->streams.read_allocated(region));
  } else {
    places.leaves.emplace(target.choices.read(region));
  }
  return places;
}

class CodedRegion;

/// Encodes kept leaves. One object per thread.
class LayerEncoder {
 public:
  LayerEncoder() = default;
  virtual ~LayerEncoder() = default;
  LayerEncoder(const LayerEncoder&) = delete;
  LayerEncoder& operator=(const LayerEncoder&) = delete;

  /// Adds the kept leaves of one x layer of one region, as far as they lie in the block. `coded`, if not null, has the
  /// streams of some of them.
  virtual void add_layer(const Block& block, const Box& leaf_box, std::int64_t region, const RegionPlaces& places,
                         const SurveyedLeaves& surveyed, std::int64_t x, const CodedRegion* coded) = 0;
  /// Writes what is still held. Call it before the thread turns to another block.
  virtual void finish() = 0;

  /// Returns the checksums of everything that was written. Call it after finish(), and only if EncodeTarget::sums.
  virtual EncodedSums sums() const = 0;
};

}  // namespace weir
