// The streams that a block coder writes of the kept blocks of a box, some regions at a time: while those of one batch
// are taken, it works on the next.
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

/// One block's: as many bytes as planned, and what they decode to, in the order of a leaf; of a resident one instead
/// its record and the digest of its values.
struct CodedStream {
  std::span<const std::byte> bytes;
  std::span<const float> decoded;
  const LeafRecord* record;
  const Digest* source;
};

/// Of one region, as far as it lies in a box.
class CodedRegion {
 public:
  /// All but the box must outlive the object.
  CodedRegion(const Box& box, const std::vector<StreamAsk>& asks, const std::optional<MadeStreams>& made)
      : box_(box), ask_of_(static_cast<std::size_t>(box.voxels()), kNone), asks_(asks), made_(made) {}

  /// `leaf` lies in the box, and asks[ask] is for its stream.
  void set(const Index3& leaf, std::size_t ask) { ask_of_[at(leaf)] = static_cast<std::int32_t>(ask); }
  /// Nullopt where the caller has to encode it.
  std::optional<CodedStream> find(const Index3& leaf) const;
  /// Of a resident region: its chunk from the first group on, up to the last stream that was asked for. What is not of
  /// those that were coded the caller has to set. Empty where nothing was.
  std::span<std::byte> chunk() const { return made_ ? made_->bytes : std::span<std::byte>(); }
  /// Of a resident region: the records of those that were asked for, in the order of the file.
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

/// Regions of a box whose streams are written together. Neither copied nor moved.
class CodedBatch {
 public:
  /// Which blocks are asked for: none, all that are transformed, or, of resident ones, those that lie wholly in the
  /// volume and are no corners of a preview: these come as they lie in the region's chunk.
  enum class Blocks { none, loaded, resident };
  /// Begins with some of `regions`, which have kept leaves in `leaf_box`, whose values are `blocks`; both must outlive
  /// the object.
  CodedBatch(const EncodeTarget& target, const Box& leaf_box, std::span<const std::int64_t> regions,
             LoadedBlocks& blocks, Blocks which = Blocks::loaded);
  /// Of one region, of which nothing is asked.
  CodedBatch(const EncodeTarget& target, const Box& leaf_box, std::int64_t region);
  CodedBatch(const CodedBatch&) = delete;
  CodedBatch& operator=(const CodedBatch&) = delete;

  struct Region {
    std::int64_t index;
    RegionPlaces places;
    Box box;  ///< its leaves in the leaf box
    CodedRegion coded;
  };
  /// Of the first ones, so many.
  std::span<const Region> regions() const { return regions_; }

  /// Waits for their streams.
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
