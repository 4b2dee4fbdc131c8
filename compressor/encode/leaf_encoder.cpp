#include "compressor/encode/leaf_encoder.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "compressor/leaf/finite_values.h"
#include "compressor/leaf/inside_voxels.h"
#include "compressor/leaf/leaf_in_block.h"
#include "compressor/leaf/quantised_leaf.h"
#include "format/leaf/leaf_codec.h"
#include "format/leaf/quantised_codec.h"
#include "ingest/source/stored_value.h"

namespace weir {
namespace {

// Gathers kept leaves, computes their statistics in batches, and writes runs of leaves that are adjacent in the file.
// One object per thread.
class LeafEncoder final : public LayerEncoder {
 public:
  explicit LeafEncoder(const EncodeTarget& target) : target_(target) {}

  void add_layer(const Block& block, const Box& leaf_box, std::int64_t region_index, const RegionPlaces& of_region,
                 const SurveyedLeaves& surveyed, std::int64_t x, const CodedRegion* /*coded*/) override {
    const LeafPlaces& places = *of_region.leaves;
    const TreeRegions& tree = target_.tree;
    const Region& region = tree.regions[static_cast<std::size_t>(region_index)];
    const Box box = intersect(tree.leaf_box(region_index), leaf_box);
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
        const Index3 leaf{x, y, z};
        const std::size_t position = tree.mask_position(leaf);
        if (!places.kept(position)) continue;
        LeafRoom room;
        const LeafInBlock seen = leaf_in_block(block, tree.leaves.voxels(leaf), room);
        surveyed.check(leaf, seen.values, seen.voxels);
        const LeafPlaces::Place before = places.before(position);
        const LeafWidth width = places.width(position);
        gather(seen, leaf,
               {region.first_leaf + before.leaves, target_.layout.leaves + region.first_byte + before.bytes, width});
      }
    }
  }

  void finish() override {
    encode_batch();
    const std::span<const std::byte> bytes(bytes_);
    std::size_t at = 0;
    for (std::size_t first = 0; first < leaves_.size();) {
      std::size_t end = first;
      std::size_t size = 0;
      do {
        size += leaf_bytes(leaves_[end++].width);
      } while (end < leaves_.size() && leaves_[end].ordinal == leaves_[end - 1].ordinal + 1);
      const TraceSpan span(target_.trace, "write", size);
      target_.out.write_at(leaves_[first].offset, bytes.subspan(at, size));
      target_.records->write(leaves_[first].ordinal, std::span(records_).subspan(first, end - first));
      at += size;
      first = end;
    }
    add_sums();
    bytes_.clear();
    records_.clear();
    leaves_.clear();
  }

  EncodedSums sums() const override { return sums_; }

 private:
  static constexpr std::size_t kHeldLeaves = 256;  // 570 KiB together with their records

  // The place of a kept leaf in the file.
  struct Leaf {
    std::uint64_t ordinal;
    std::uint64_t offset;
    LeafWidth width;
  };

  void add_sums() {
    if (!target_.sums) return;
    std::size_t at = 0;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      const std::size_t size = leaf_bytes(leaves_[i].width);
      sums_.volume += placed_checksum(leaves_[i].offset, std::span<const std::byte>(bytes_).subspan(at, size));
      sums_.records += record_checksum(leaves_[i].ordinal, records_[i]);
      at += size;
    }
  }

  void gather(const LeafInBlock& seen, const Index3& leaf, const Leaf& place) {
    const Box node = target_.tree.leaves.node_box(leaf);
    const Box inside = target_.tree.leaves.voxels(leaf);
    LeafValues& values = values_[batch_];
    gather_leaf(seen.values, seen.voxels, node, inside, target_.fill.background, values);
    finite_[batch_] = all_finite(values);
    if (!finite_[batch_] && target_.fill.non_finite != NonFinitePolicy::keep) {
      sources_[batch_] = values;
      for (float& v : values) v = std::isfinite(v) ? v : target_.fill.background;
    }
    const bool gaps = !finite_[batch_] && target_.fill.gaps;
    masks_[batch_] = gaps ? active_voxels(sources_[batch_], node, inside) : std::nullopt;
    nodes_[batch_] = node;
    insides_[batch_] = inside;
    repeats_[batch_] = LeafRepeats::in_leaf_order(seen.by);
    leaves_.push_back(place);
    if (++batch_ == kLeafBatch) encode_batch();
    if (leaves_.size() >= kHeldLeaves) finish();
  }

  // Returns the active voxels of a leaf if some of its voxels are missing. The first and the last voxel of the domain
  // are always active, so that the box of the active voxels is the domain.
  std::optional<LeafMask> active_voxels(const LeafValues& source, const Box& node, const Box& inside) const {
    LeafMask mask;
    for_each_inside(node, inside, [&](std::size_t i) { mask[i] = !is_missing(source[i]); });
    const Box& domain = target_.tree.leaves.domain;
    for (const Index3& corner : {domain.lo, domain.hi - Index3{1, 1, 1}}) {
      const Index3 i = corner - node.lo;
      if (node.contains(corner)) mask.set(static_cast<std::size_t>(i.x << 6 | i.y << 3 | i.z));
    }
    return std::cmp_equal(mask.count(), inside.voxels()) ? std::nullopt : std::optional(mask);
  }

  void encode_batch() {
    const std::size_t first = leaves_.size() - batch_;
    if (target_.type != GridType::float32) {
      for (std::size_t i = 0; i < batch_; ++i) {
        const LeafValues& source = finite_[i] ? values_[i] : sources_[i];
        const Leaf& leaf = leaves_[first + i];
        quantised_[i] = quantise_leaf(values_[i], source, nodes_[i], insides_[i], bits_log2_of(leaf.width), target_.fit,
                                      repeats_[i]);
        values_[i] = quantised_[i].decoded;
      }
    }
    const std::span<NodeStatistics> statistics(statistics_.data(), batch_);
    full_leaf_statistics({values_.data(), batch_}, {nodes_.data(), batch_}, statistics);
    for (std::size_t i = 0; i < batch_; ++i) {
      if (insides_[i] != nodes_[i]) statistics[i] = leaf_statistics(values_[i], nodes_[i], insides_[i]);
      records_.push_back(make_leaf_record(values_[i], nodes_[i], insides_[i], statistics[i]));
      if (masks_[i]) {
        statistics[i] = leaf_statistics(values_[i], nodes_[i], *masks_[i]);
        set_active(records_.back(), *masks_[i], nodes_[i], insides_[i], statistics[i]);
      }
      const std::size_t at = bytes_.size();
      bytes_.resize(at + leaf_bytes(leaves_[first + i].width));
      const std::span<std::byte> image = std::span(bytes_).subspan(at);
      if (target_.type == GridType::float32) {
        encode_float_leaf(values_[i], nodes_[i], insides_[i], statistics[i], image.first<nvdb::kFloatLeafBytes>());
      } else {
        const QuantisedLeaf& leaf = quantised_[i];
        encode_quantised_leaf(target_.type, leaf.codes, leaf.bits_log2, leaf.quantiser.minimum, leaf.quantiser.quantum,
                              nodes_[i], insides_[i], statistics[i], image);
        records_.back().squared_error = leaf.squared_error;
        records_.back().max_abs = leaf.max_abs;
        records_.back().kept = leaf.kept;
        records_.back().zeros_lost = leaf.zeros_lost;
      }
      if (masks_[i]) set_active_voxels(nodes_[i], *masks_[i], image);
    }
    batch_ = 0;
  }

  const EncodeTarget& target_;
  std::size_t batch_ = 0;  // number of leaves that are gathered but not yet encoded: the last ones of leaves_
  std::array<LeafValues, kLeafBatch> values_{};
  std::array<LeafValues, kLeafBatch> sources_{};  // values before non-finite ones, if any, were replaced
  std::array<bool, kLeafBatch> finite_{};
  std::array<std::optional<LeafMask>, kLeafBatch> masks_{};  // active voxels, if some voxels in the domain are inactive
  std::array<QuantisedLeaf, kLeafBatch> quantised_{};
  std::array<Box, kLeafBatch> nodes_{};
  std::array<Box, kLeafBatch> insides_{};
  std::array<LeafRepeats, kLeafBatch> repeats_{};
  std::array<NodeStatistics, kLeafBatch> statistics_{};
  std::vector<Leaf> leaves_;  // all held leaves, encoded or not
  std::vector<std::byte> bytes_;
  std::vector<LeafRecord> records_;
  EncodedSums sums_;
};

}  // namespace

std::unique_ptr<LayerEncoder> make_leaf_encoder(const EncodeTarget& target) {
  return std::make_unique<LeafEncoder>(target);
}

}  // namespace weir
