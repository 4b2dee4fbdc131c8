#include "ingest/vdb/leaf_source.h"

#include <array>
#include <cstring>
#include <mutex>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/plan/for_pieces.h"
#include "ingest/plan/staging.h"
#include "ingest/source/extent.h"
#include "ingest/values/decode_component.h"

namespace weir {
namespace {

/// A box with fewer voxels per thread than this is not worth another thread.
constexpr std::int64_t kVoxelsPerThread = 64 * 1024;

constexpr std::size_t kLeafValues = kLeafVoxels;
constexpr std::size_t kMaxValueBytes = 24;  // vectors of three doubles
using LeafBytes = std::array<std::byte, kLeafValues * kMaxValueBytes>;

/// Copies the values of `part` (in voxels from the leaf's corner) out of a leaf, x fastest, `Bytes` bytes each.
template <std::size_t Bytes>
void pack(const LeafBytes& leaf, const Box& part, std::byte* packed) {
  for (std::int64_t z = part.lo.z; z < part.hi.z; ++z) {
    for (std::int64_t y = part.lo.y; y < part.hi.y; ++y) {
      for (std::int64_t x = part.lo.x; x < part.hi.x; ++x, packed += Bytes) {
        std::memcpy(packed, leaf.data() + Bytes * static_cast<std::size_t>(x << 6 | y << 3 | z), Bytes);
      }
    }
  }
}

void pack(const LeafBytes& leaf, std::size_t value_bytes, const Box& part, std::byte* packed) {
  switch (value_bytes) {
    case 1:
      return pack<1>(leaf, part, packed);
    case 2:
      return pack<2>(leaf, part, packed);
    case 4:
      return pack<4>(leaf, part, packed);
    case 12:
      return pack<12>(leaf, part, packed);
    case 24:
      return pack<24>(leaf, part, packed);
    default:
      return pack<8>(leaf, part, packed);
  }
}

class LeafSource final : public VolumeSource {
 public:
  LeafSource(std::unique_ptr<LeafTree> tree, SourceInfo info, const VoxelComponents& components)
      : tree_(std::move(tree)),
        info_(std::move(info)),
        components_(components),
        value_bytes_(scalar_bytes(info_.type) * static_cast<std::size_t>(components.count)) {}

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {value_bytes_, {}, {}}; }
  bool in_memory() const override { return tree_->in_memory(); }
  std::uint64_t working_bytes() const override { return tree_->working_bytes(); }
  std::uint64_t bytes_read() const override { return tree_->bytes_read(); }

  ConversionLoss read(const Box& box, std::span<float> values) override {
    check(box, values.size());
    const NodeLattice leaves = make_lattice(box, kLeafDim);
    const std::int64_t threads =
        std::clamp<std::int64_t>(box.voxels() / kVoxelsPerThread, 1, static_cast<std::int64_t>(kIoThreads));
    ConversionLoss total;
    std::mutex mutex;
    for_pieces(leaves.count.y * leaves.count.z, static_cast<std::size_t>(threads), [&](std::int64_t row) {
      const auto reader = tree_->reader();
      const ConversionLoss loss = read_row(*reader, leaves, row, values);
      const std::lock_guard lock(mutex);
      total.add(loss);
    });
    return total;
  }

  ConversionLoss read_alone(const Box& box, std::span<float> values) override {
    check(box, values.size());
    const NodeLattice leaves = make_lattice(box, kLeafDim);
    const auto reader = tree_->reader();
    ConversionLoss total;
    for (std::int64_t row = 0; row < leaves.count.y * leaves.count.z; ++row) {
      total.add(read_row(*reader, leaves, row, values));
    }
    return total;
  }

 private:
  void check(const Box& box, std::size_t values) const {
    if (box.empty() || !info_.domain().contains(box) || std::cmp_not_equal(values, box.voxels())) {
      throw Error(ErrorKind::internal, cat(info_.path, ": read of box ", box_text(box), " into ", values,
                                           " values does not fit ", box_text(info_.domain())));
    }
  }

  /// Reads the leaves of one row along x, among the leaves over a box, into the box's values.
  ConversionLoss read_row(LeafReader& reader, const NodeLattice& leaves, std::int64_t row, std::span<float> values) {
    const Box& box = leaves.domain;
    const Index3 extent = box.extent();
    LeafBytes leaf;
    LeafBytes packed;
    std::array<float, kLeafValues> decoded;
    ConversionLoss loss;
    for (std::int64_t i = 0; i < leaves.count.x; ++i) {
      const Index3 at{i, row % leaves.count.y, row / leaves.count.y};
      const Index3 corner = leaves.node_box(at).lo;
      const Box part = leaves.voxels(at);
      const auto count = static_cast<std::size_t>(part.voxels());
      reader.read(corner, std::span(leaf).first(kLeafValues * value_bytes_));
      pack(leaf, value_bytes_, {part.lo - corner, part.hi - corner}, packed.data());
      loss.add(decode_component(std::span(packed).first(count * value_bytes_), info_.type, false, info_.mapping,
                                components_, std::span(decoded).first(count)));
      const auto run = static_cast<std::size_t>(part.extent().x);
      const float* from = decoded.data();
      for (std::int64_t z = part.lo.z; z < part.hi.z; ++z) {
        for (std::int64_t y = part.lo.y; y < part.hi.y; ++y, from += run) {
          const auto to = static_cast<std::size_t>(linear_index(Index3{part.lo.x, y, z} - box.lo, extent));
          std::memcpy(values.data() + to, from, run * sizeof(float));
        }
      }
    }
    return loss;
  }

  std::unique_ptr<LeafTree> tree_;
  SourceInfo info_;
  VoxelComponents components_;
  std::size_t value_bytes_;
};

}  // namespace

std::unique_ptr<VolumeSource> make_leaf_source(std::unique_ptr<LeafTree> tree, SourceInfo info,
                                               const VoxelComponents& components) {
  return std::make_unique<LeafSource>(std::move(tree), std::move(info), components);
}

}  // namespace weir
