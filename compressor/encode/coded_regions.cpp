#include "compressor/encode/coded_regions.h"

#include <utility>

#include "format/packed/stream_length.h"

namespace weir {
namespace {

// The most blocks of a batch: 16 MiB of values. A batch has at least one region.
constexpr std::size_t kMostBlocks = 8192;
constexpr std::size_t kRegionBlocks = 4096;

// Returns the kind of a planned stream to ask for; nullopt if the caller must encode the stream.
std::optional<StreamAskKind> kind_of(const PackedTarget& packed, std::int16_t step, std::uint32_t bytes) {
  if (PlannedStreams::transforms(step)) return StreamAskKind::transform;
  if (PlannedStreams::is_near(step)) return StreamAskKind::rounded;
  const bool exact = step == PlannedStreams::kExactStep && bytes < kRawStreamBytes && !packed.lattice;
  return exact ? std::optional(StreamAskKind::exact) : std::nullopt;
}

}  // namespace

std::optional<CodedStream> CodedRegion::find(const Index3& leaf) const {
  const std::int32_t ask = ask_of_[at(leaf)];
  if (ask == kNone || !made_) return std::nullopt;
  const auto i = static_cast<std::size_t>(ask);
  if (made_->made[i] == 0) return std::nullopt;
  const std::span<const std::byte> bytes = made_->bytes.subspan(asks_[i].offset, asks_[i].bytes);
  if (!made_->records.empty()) return CodedStream{bytes, {}, &made_->records[i], &made_->sources[i]};
  return CodedStream{bytes, made_->decoded.subspan(kLeafVoxels * i, kLeafVoxels), nullptr, nullptr};
}

CodedBatch::CodedBatch(const EncodeTarget& target, const Box& leaf_box, std::span<const std::int64_t> regions,
                       LoadedBlocks& blocks, Blocks which)
    : which_(which) {
  for (const std::int64_t region : regions) {
    add(target, leaf_box, region);
    if (asks_.size() + kRegionBlocks > kMostBlocks) break;
  }
  if (!asks_.empty()) pending_ = blocks.encode(asks_, target.packed->constants);
}

CodedBatch::CodedBatch(const EncodeTarget& target, const Box& leaf_box, std::int64_t region) : which_(Blocks::none) {
  add(target, leaf_box, region);
}

bool CodedBatch::asks_for(const EncodeTarget& target, const Index3& leaf) const {
  if (which_ != Blocks::resident) return which_ == Blocks::loaded;
  const NodeLattice& leaves = target.tree.leaves;
  return leaves.voxels(leaf) == leaves.node_box(leaf) && !(target.packed->rule.preview && is_corner(leaves, leaf));
}

void CodedBatch::add(const EncodeTarget& target, const Box& leaf_box, std::int64_t region) {
  RegionPlaces places = places_of(target, region);
  const Box box = intersect(target.tree.leaf_box(region), leaf_box);
  CodedRegion coded(box, asks_, made_);
  const StreamPlaces& streams = *places.streams;
  // Asks in the order of the streams in the file, so that the streams of a layer lie together.
  for_each_in_file_order(box, [&](const Index3& leaf) {
    const std::size_t position = target.tree.mask_position(leaf);
    const std::int16_t step = streams.plan().steps[position];
    if (!streams.kept(position) || !asks_for(target, leaf)) return;
    const std::optional<StreamAskKind> kind = kind_of(*target.packed, step, streams.bytes(position));
    if (!kind) return;
    const bool rounded = *kind == StreamAskKind::rounded;
    const std::uint32_t next = asks_.empty() ? 0 : asks_.back().offset + asks_.back().bytes;
    const std::uint32_t offset = which_ == Blocks::resident ? streams.offset(position) - streams.base(0) : next;
    coded.set(leaf, asks_.size());
    asks_.push_back({streams.plan().region.means,
                     static_cast<std::uint32_t>(linear_index(leaf - leaf_box.lo, leaf_box.extent())), offset,
                     static_cast<std::uint16_t>(streams.bytes(position)),
                     rounded ? static_cast<std::int16_t>(step - PlannedStreams::kNearStep) : step, *kind});
  });
  regions_.push_back({region, std::move(places), box, std::move(coded)});
}

}  // namespace weir
