#include "compressor/encode/packed_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "compressor/encode/coded_regions.h"
#include "compressor/encode/record_batch.h"
#include "compressor/encode/stream_pieces.h"
#include "compressor/leaf/finite_values.h"
#include "compressor/leaf/inside_voxels.h"
#include "compressor/leaf/leaf_difference.h"
#include "compressor/leaf/leaf_in_block.h"
#include "compressor/packed/block_values.h"
#include "compressor/packed/exact_block.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/digest.h"
#include "format/packed/block_decode.h"
#include "format/packed/block_encode.h"
#include "format/packed/rounded_block.h"
#include "format/packed/stream_length.h"

namespace weir {
namespace {

class PackedEncoder final : public PackedLayerEncoder {
 public:
  explicit PackedEncoder(const EncodeTarget& target)
      : target_(target), packed_(*target.packed), records_(target.records, target.sums) {
    stream_.resize(kStreamRoom);
  }

  void add_layer(const Block& block, const Box& leaf_box, std::int64_t region_index, const RegionPlaces& of_region,
                 const SurveyedLeaves& surveyed, std::int64_t x, const CodedRegion* coded) override {
    const Box box = intersect(target_.tree.leaf_box(region_index), leaf_box);
    for_each_kept(region_index, *of_region.streams, box, x, [&](const Index3& leaf, const KeptPlace& place) {
      begin_leaf(leaf);
      LeafRoom room;
      const LeafInBlock seen = leaf_in_block(block, inside_, room);
      surveyed.check(leaf, seen.values, seen.voxels);
      gather_leaf(seen.values, seen.voxels, node_, inside_, target_.fill.background, source_);
      const std::optional<CodedStream> known = coded == nullptr ? std::nullopt : coded->find(leaf);
      if (known) {
        replaced_ = false;
        std::copy(known->decoded.begin(), known->decoded.end(), decoded_.begin());
        append(place.offset, known->bytes);
        if (packed_.rule.preview) write_corner(leaf);
      } else {
        add_stream(leaf, place);
      }
      records_.add(place.ordinal, decoded_, node_, inside_, loss());
    });
  }

  void add_layer(std::int64_t region_index, const RegionPlaces& of_region, const SurveyedLeaves& surveyed,
                 std::int64_t x, const CodedRegion& coded, const LeftLeaves& left, RecordSink& records) override {
    records_.write_to(records);
    const Box box = target_.tree.leaf_box(region_index);
    const StreamPlaces& places = *of_region.streams;
    chunk_ = {coded.chunk(), chunk_offset(target_, region_index) + places.base(0)};
    surveyed.prefetch_layer(x);
    for_each_kept(region_index, places, box, x, [&](const Index3& leaf, const KeptPlace& place) {
      if (const std::optional<CodedStream> known = coded.find(leaf)) {
        surveyed.check(leaf, *known->source);
        chunk_.add(place.offset, known->bytes.size());
        if (target_.sums) volume_sum_ += placed_checksum(place.offset, known->bytes);
        return records_.add(place.ordinal, *known->record);
      }
      begin_leaf(leaf);
      std::copy_n(left.find(leaf), source_.size(), source_.begin());
      LeafValues own;
      surveyed.check(leaf, leaf_digest(in_domain_values(source_.data(), node_, inside_, own)));
      add_stream(leaf, place);
      records_.add(place.ordinal, decoded_, node_, inside_, loss());
    });
    write_part(std::exchange(chunk_, {}));
  }

  void finish() override {
    flush_bytes();
    records_.flush();
  }

  EncodedSums sums() const override { return {volume_sum_, records_.sum()}; }

 private:
  static constexpr std::size_t kHeldBytes = std::size_t{1} << 18U;

  // Calls visit(leaf, place) for the kept leaves of layer `x` of a region, as far as they lie in `box`. Before the
  // leaves of a group, appends the ends of the group's streams.
  template <typename Visit>
  void for_each_kept(std::int64_t region, const StreamPlaces& places, const Box& box, std::int64_t x,
                     const Visit& visit) {
    for_each_kept_stream(
        target_, region, places, box, x,
        [&](std::uint64_t offset, std::span<const std::byte> ends) { append(offset, ends); }, visit);
  }

  void begin_leaf(const Index3& leaf) {
    node_ = target_.tree.leaves.node_box(leaf);
    inside_ = target_.tree.leaves.voxels(leaf);
  }

  // Encodes source_, decodes the stream for the leaf's errors, and appends the stream.
  void add_stream(const Index3& leaf, const KeptPlace& place) {
    const StreamPlaces& places = place.places;
    values_ = source_;
    replaced_ = target_.fill.non_finite != NonFinitePolicy::keep && !all_finite(source_);
    if (replaced_) {
      for (float& v : values_) v = std::isfinite(v) ? v : target_.fill.background;
    }
    extend_outside(node_, inside_, values_);
    const std::span<std::byte> stream = std::span(stream_).first(places.bytes(place.position));
    write_stream(leaf, places.plan(), place.position, stream);
    decode_stream(leaf, place, stream);
    append(place.offset, stream);
    if (packed_.rule.preview) write_corner(leaf);
  }

  void write_stream(const Index3& leaf, const PlannedStreams& plan, std::size_t position, std::span<std::byte> stream) {
    const std::int16_t step = plan.steps[position];
    if (PlannedStreams::is_near(step)) {
      rounded_.set(values_);
      if (!rounded_.encode(step - PlannedStreams::kNearStep, stream)) fail(leaf, "cannot be rounded");
      return;
    }
    if (PlannedStreams::transforms(step)) {
      if (!transform_.set(values_)) fail(leaf, "cannot be transformed");
      transform_.encode(packed_.constants, plan.region.means, step, stream);
      return;
    }
    std::uint32_t bytes = 0;
    std::vector<std::byte>& scratch = exact_;
    scratch.resize(kStreamRoom);
    if (step == PlannedStreams::kBoundedStep) {
      bytes = exact_block_.write_bounded(values_, *packed_.max_error, scratch);
    } else if (stream.size() == kRawStreamBytes) {
      bytes = encode_raw(values_, scratch);
    } else {
      bytes = exact_block_.write(values_, packed_.lattice, scratch);
    }
    if (bytes != stream.size()) fail(leaf, "has another length than was planned");
    std::copy_n(scratch.begin(), bytes, stream.begin());
  }

  // Sets decoded_ to the values that the stream decodes to. For transformed and rounded values they are known without
  // decoding. One such stream in 64, and each that was too short for its step, is decoded all the same as a check.
  void decode_stream(const Index3& leaf, const KeptPlace& place, std::span<const std::byte> stream) {
    constexpr std::uint64_t kChecked = 64;
    const bool known = know_values(place.places.plan(), place.position);
    if (known && !shortened_ && place.ordinal % kChecked != 0) return;
    LeafValues& decoded = known ? checked_ : decoded_;
    if (!decode_block(packed_.constants, place.places.plan().region.means, stream.data(),
                      static_cast<std::uint32_t>(stream.size()), decoded.data())) {
      fail(leaf, "does not decode");
    }
    if (known && std::memcmp(checked_.data(), decoded_.data(), sizeof decoded_) != 0) {
      fail(leaf, "decodes to other values than were coded");
    }
  }

  // Returns whether the decoded values are known from write_stream(), and sets decoded_ to them if so.
  bool know_values(const PlannedStreams& plan, std::size_t position) {
    const std::int16_t step = plan.steps[position];
    shortened_ =
        PlannedStreams::is_near(step) ? rounded_.coarser() : PlannedStreams::transforms(step) && transform_.dropped();
    if (PlannedStreams::is_near(step)) {
      rounded_.decoded(packed_.constants, decoded_);
      return true;
    }
    return PlannedStreams::transforms(step) && transform_.decoded(packed_.constants, plan.region.means, step, decoded_);
  }

  void write_corner(const Index3& leaf) {
    if (!is_corner(target_.tree.leaves, leaf)) return;
    LeafValues outside;
    outside.fill(target_.fill.background);
    const LeafValues values = inside_only(decoded_, outside, node_, inside_);
    std::array<std::byte, nvdb::kFloatLeafBytes> image{};
    encode_float_leaf(values, node_, inside_, leaf_statistics(values, node_, inside_), image);
    const std::uint64_t offset = corner_offset(target_.layout, leaf);
    target_.out.write_at(offset, image);
    if (target_.sums) volume_sum_ += placed_checksum(offset, image);
  }

  DecodedErrors loss() const {
    const LeafDifference lost = difference_from(source_);
    const LeafDifference of_all = replaced_ ? difference_from(values_) : lost;
    const bool every_bit = of_all.different == 0 && of_all.nonfinite_different == 0;
    return {lost.squared_error, lost.max_abs, kept_of(replaced_ && lost.different == 0, every_bit), lost.zeros_lost};
  }

  // Returns the difference between `before` and decoded_ over the in-domain voxels.
  LeafDifference difference_from(const LeafValues& before) const {
    if (inside_ == node_) return difference_of(before, decoded_);
    return difference_of(inside_only(before, decoded_, node_, inside_), decoded_);
  }

  // The chunk that holds a coder's streams, at `offset` of the file, and the part of it to be written: from
  // `written_from` to `written_to`, both offsets in the file.
  struct ChunkPart {
    std::span<std::byte> bytes{};
    std::uint64_t offset = 0;
    std::uint64_t written_from = 0;
    std::uint64_t written_to = 0;  // 0: nothing to write

    bool holds(std::uint64_t at, std::size_t size) const { return at - offset + size <= bytes.size(); }
    // Adds a piece. The pieces of a layer are adjacent and come in order.
    void add(std::uint64_t at, std::size_t size) {
      if (written_to == 0) written_from = at;
      written_to = at + size;
    }
  };

  void append(std::uint64_t offset, std::span<const std::byte> bytes) {
    if (target_.sums) volume_sum_ += placed_checksum(offset, bytes);
    if (chunk_.holds(offset, bytes.size())) {
      std::copy(bytes.begin(), bytes.end(), chunk_.bytes.subspan(offset - chunk_.offset).begin());
      chunk_.add(offset, bytes.size());
      return;
    }
    if (!bytes_.empty() && offset != first_byte_ + bytes_.size()) flush_bytes();
    if (bytes_.empty()) first_byte_ = offset;
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    if (bytes_.size() >= kHeldBytes) flush_bytes();
  }

  void write_part(const ChunkPart& part) {
    if (part.written_to == 0) return;
    const std::uint64_t bytes = part.written_to - part.written_from;
    const TraceSpan span(target_.trace, "write", bytes);
    target_.out.write_at(part.written_from, part.bytes.subspan(part.written_from - part.offset, bytes));
  }

  void flush_bytes() {
    if (bytes_.empty()) return;
    const TraceSpan span(target_.trace, "write", bytes_.size());
    target_.out.write_at(first_byte_, bytes_);
    bytes_.clear();
  }

  [[noreturn]] static void fail(const Index3& leaf, const char* what) {
    throw Error(ErrorKind::internal,
                cat("packed block ", leaf.x, ",", leaf.y, ",", leaf.z, " ", what, "; report this"));
  }

  const EncodeTarget& target_;
  const PackedTarget& packed_;
  TransformBlock transform_;
  RoundedBlock rounded_;
  ExactBlock exact_block_;
  Box node_;
  Box inside_;
  LeafValues source_{};    // values of the source; undefined outside the domain
  LeafValues values_{};    // the values that are packed
  bool replaced_ = false;  // whether non-finite values of the source were replaced
  LeafValues decoded_{};
  LeafValues checked_{};    // values of a stream that was decoded as a check
  bool shortened_ = false;  // the stream has fewer coefficients, or a larger quantum, than planned
  std::vector<std::byte> stream_;
  std::vector<std::byte> exact_;
  ChunkPart chunk_;  // chunk of the current layer's region, if a coder has looked at it
  std::uint64_t first_byte_ = 0;
  std::vector<std::byte> bytes_;  // to be written from first_byte_ on
  std::uint64_t volume_sum_ = 0;  // sum of the checksums of all appended pieces and corner leaves
  RecordBatch records_;
};

}  // namespace

std::unique_ptr<PackedLayerEncoder> make_packed_encoder(const EncodeTarget& target) {
  return std::make_unique<PackedEncoder>(target);
}

}  // namespace weir
