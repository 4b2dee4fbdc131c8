// What the encode pass hands blocks to, a layer at a time.
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

/// What packed blocks are encoded with.
struct PackedTarget {
  const PlannedStreamsStore& streams;
  PackedRule rule;
  BlockConstants constants;
  std::optional<Lattice> lattice;   ///< of the whole volume
  std::optional<double> max_error;  ///< where the budget bounds it
  BlockCoder* coder = nullptr;      ///< encodes many blocks at a time, where there is one
};

/// Takes the records of a region once all of them are there. Thread-safe for different regions.
class RegionSink {
 public:
  RegionSink() = default;
  virtual ~RegionSink() = default;
  RegionSink(const RegionSink&) = delete;
  RegionSink& operator=(const RegionSink&) = delete;

  /// `records` are those of its kept leaves, one at least, in their order.
  virtual void take(std::int64_t region, std::span<const LeafRecord> records) = 0;
};

struct EncodeTarget {
  const TreeRegions& tree;
  const ChoiceStore& choices;
  const TreeLayout& layout;
  Fill fill;
  GridType type;  ///< float32 or quantised
  Fit fit;        ///< of quantised leaves
  File& out;
  RecordStore* records;  ///< null where `regions` takes them
  const RowStore& rows;  ///< of the survey; each rank of its team encodes the leaves of its own regions
  Trace* trace = nullptr;
  const PackedTarget* packed = nullptr;  ///< where blocks are packed; then `type` and `fit` mean nothing
  bool sums = true;                      ///< whether LayerEncoder::sums() is asked for, as a journal does
  RegionSink* regions = nullptr;         ///< of a volume on a device: takes the records in place of a store
};

/// Where the kept blocks of a region lie.
struct RegionPlaces {
  std::optional<LeafPlaces> leaves;
  std::optional<StreamPlaces> streams;  ///< of packed blocks
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

/// One per thread.
class LayerEncoder {
 public:
  LayerEncoder() = default;
  virtual ~LayerEncoder() = default;
  LayerEncoder(const LayerEncoder&) = delete;
  LayerEncoder& operator=(const LayerEncoder&) = delete;

  /// The kept leaves of one x layer of one region, as far as they lie in the block. `coded`, where given, has streams
  /// of some of them.
  virtual void add_layer(const Block& block, const Box& leaf_box, std::int64_t region, const RegionPlaces& places,
                         const SurveyedLeaves& surveyed, std::int64_t x, const CodedRegion* coded) = 0;
  /// Writes what is still held; call before the thread turns to another block.
  virtual void finish() = 0;

  /// Checksums of all that it has written, after finish(). Only where the target says that they are asked for.
  virtual EncodedSums sums() const = 0;
};

}  // namespace weir
