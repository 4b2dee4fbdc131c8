// The streams that a block coder writes for the kept blocks of a box, in batches of regions. The coder works on the
// next batch while the streams of the current one are taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compressor/encode/layer_encoder.h"
#include "format/base/index.h"
#include "format/packed/block_coder.h"

namespace weir {

/// The stream of one block. `bytes` has the planned length. A loaded block also has its decoded values, in the order of
/// a leaf. A resident block instead has its record and the digest of its source values.
struct CodedStream {
  std::span<const std::byte> bytes;
  std::span<const float> decoded;
  const LeafRecord* record;
  const Digest* source;
};

/// The coded streams of one region, as far as the region lies in a box.
class CodedRegion {
 public:
  /// `asks` and `made` must outlive the object.
  CodedRegion(const Box& box, const std::vector<StreamAsk>& asks, const std::optional<MadeStreams>& made)
      : box_(box), ask_of_(static_cast<std::size_t>(box.voxels()), kNone), asks_(asks), made_(made) {}

  /// Records that asks[ask] asks for the stream of `leaf`, which must lie in the box.
  void set(const Index3& leaf, std::size_t ask) { ask_of_[at(leaf)] = static_cast<std::int32_t>(ask); }
  /// Returns the stream of `leaf`, or nullopt if the caller has to encode the leaf.
  std::optional<CodedStream> find(const Index3& leaf) const;
  /// Returns the chunk of a resident region, from the first group to the last stream that was asked for. The caller
  /// must set all bytes that belong to no coded stream. Empty if nothing was coded.
  std::span<std::byte> chunk() const { return made_ ? made_->bytes : std::span<std::byte>(); }
  /// Returns the records of the leaves of a resident region that were asked for, in the order of the file.
  std::span<const LeafRecord> records() const { return made_ ? made_->records : std::span<const LeafRecord>(); }

 private:
  static constexpr std::int32_t kNone = -1;
  std::size_t at(const Index3& leaf) const {
    return static_cast<std::size_t>(linear_index(leaf - box_.lo, box_.extent()));
  }

  Box box_;
  std::vector<std::int32_t> ask_of_;
  const std::vector<StreamAsk>& asks_;
  const std::optional<MadeStreams>& made_;
};

/// Regions of a box that get their streams written together. Cannot be copied or moved.
class CodedBatch {
 public:
  /// Which kept blocks the coder is asked for, among those with a stream of a kind that it writes. `none`: no block.
  /// `loaded`: all blocks. `resident`: the blocks of a device that lie wholly in the volume and are no corner of a
  /// preview; their streams come as they lie in the region's chunk.
  enum class Blocks { none, loaded, resident };
  /// Begins to code the first few of `regions`. Each has kept leaves in `leaf_box`, and `blocks` holds the values of
  /// that box. `target` and `blocks` must outlive the object.
  CodedBatch(const EncodeTarget& target, const Box& leaf_box, std::span<const std::int64_t> regions,
             LoadedBlocks& blocks, Blocks which = Blocks::loaded);
  /// Makes a batch of one region and asks for no stream.
  CodedBatch(const EncodeTarget& target, const Box& leaf_box, std::int64_t region);
  CodedBatch(const CodedBatch&) = delete;
  CodedBatch& operator=(const CodedBatch&) = delete;

  struct Region {
    std::int64_t index;
    RegionPlaces places;
    Box box;  ///< its leaves in the leaf box
    CodedRegion coded;
  };
  /// Returns the regions of this batch: the first ones of the constructor's `regions`.
  std::span<const Region> regions() const { return regions_; }

  /// Waits for the streams of the batch.
  void wait() {
    if (pending_) made_ = pending_->wait();
  }

 private:
  void add(const EncodeTarget& target, const Box& leaf_box, std::int64_t region);
  bool asks_for(const EncodeTarget& target, const Index3& leaf) const;

  Blocks which_;
  std::vector<StreamAsk> asks_;
  std::vector<Region> regions_;
  std::optional<MadeStreams> made_;
  std::unique_ptr<PendingStreams> pending_;
};

}  // namespace weir
