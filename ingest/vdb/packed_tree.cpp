#include "ingest/vdb/packed_tree.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "format/packed/packed_layout.h"
#include "ingest/vdb/nvdb_leaf_tree.h"

namespace weir {
namespace {

class StoredPackedTree final : public LeafTree {
 public:
  StoredPackedTree(std::unique_ptr<InputFile> file, const NvdbGrid& grid, bool cached)
      : file_(std::move(file)),
        begin_(grid.packed()->file_offset()),
        nodes_(*file_, begin_, begin_ + grid.packed()->bytes().size()),
        header_(grid.packed()->header()),
        constants_(header_.constants()),
        background_(grid.background()),
        cached_(cached) {
    regions_.resize(static_cast<std::size_t>(header_.regions.size()));
    for (std::int64_t i = 0; i < header_.regions.size(); ++i) {
      regions_[static_cast<std::size_t>(i)] = grid.packed()->region(header_.regions.position(i));
    }
  }

  std::unique_ptr<LeafReader> reader() const override;
  bool in_memory() const override { return cached_; }
  std::uint64_t working_bytes() const override {
    return NvdbNodes::kLimit + regions_.size() * sizeof(PackedRegion) + sizeof(PackedHeader);
  }
  std::uint64_t bytes_read() const override { return file_->bytes_read(); }

  // Returns the region of a voxel; null outside the regions.
  const PackedRegion* region_of(const Index3& voxel) const {
    const Index3 position = floor_div(voxel, kLowerDim) - header_.regions.first;
    if (!Box{{0, 0, 0}, header_.regions.count}.contains(position)) return nullptr;
    return &regions_[static_cast<std::size_t>(header_.regions.linear(position))];
  }
  float background() const { return background_; }
  const BlockConstants& constants() const { return constants_; }
  const std::string& path() const { return file_->path(); }
  std::uint64_t file_offset(const PackedRegion& region) const { return begin_ + region.chunk; }

  NvdbNodes::Node read_head(const PackedRegion& region) const {
    return nodes_.read(file_offset(region), packed::chunk::kGroups, begin_ + header_.table);
  }
  void read(std::uint64_t at, std::span<std::byte> bytes, std::uint64_t from) const {
    nodes_.check(at, bytes.size(), from);
    file_->read_buffered(at, bytes, ReadPath::cache);
  }

 private:
  std::unique_ptr<InputFile> file_;
  std::uint64_t begin_;  // of the packed data, in the file
  mutable NvdbNodes nodes_;
  PackedHeader header_;
  BlockConstants constants_;
  float background_;
  bool cached_;
  std::vector<PackedRegion> regions_;
};

class PackedBlocks final : public LeafReader {
 public:
  explicit PackedBlocks(const StoredPackedTree& tree) : tree_(tree) {}

  void read(const Index3& origin, std::span<std::byte> values) override {
    std::array<float, kLeafVoxels> decoded;
    const PackedRegion* const region = tree_.region_of(origin);
    if (region == nullptr) {
      decoded.fill(tree_.background());
    } else if (region->chunk == 0 || !decode(*region, floor_div(origin, kLeafDim), decoded)) {
      decoded.fill(region->value);
    }
    std::memcpy(values.data(), decoded.data(), sizeof decoded);
  }

 private:
  // Decodes the block; returns false if the block has no stream.
  bool decode(const PackedRegion& region, const Index3& block, std::span<float, kLeafVoxels> values) {
    if (region_ != &region) {
      head_ = tree_.read_head(region);
      region_ = &region;
      group_at_ = 0;
    }
    const NvdbBytes head(*head_, tree_.file_offset(region), tree_.path());
    const unsigned position = packed_position(block);
    const PackedGroup group = packed_group(head, region.bytes, position / packed::chunk::kGroupBlocks);
    const auto bit = static_cast<unsigned>(position % packed::chunk::kGroupBlocks);
    if (!group.has(bit)) return false;
    const std::uint64_t at = tree_.file_offset(region) + group.begin;
    hold_group(at, group.end - group.begin, tree_.file_offset(region));
    const NvdbBytes bytes(group_, at, tree_.path());
    const auto found = packed_stream(bytes, group, bit);
    const PackedStream stream{found.data(), static_cast<std::uint32_t>(found.size()), packed_means(head)};
    decode_packed_stream(tree_.constants(), stream, values,
                         at + static_cast<std::uint64_t>(found.data() - group_.data()), tree_.path());
    return true;
  }

  void hold_group(std::uint64_t at, std::uint64_t bytes, std::uint64_t from) {
    if (group_at_ == at && group_.size() == bytes) return;
    group_at_ = 0;  // in case reading fails
    group_.resize(bytes);
    tree_.read(at, group_, from);
    group_at_ = at;
  }

  const StoredPackedTree& tree_;
  const PackedRegion* region_ = nullptr;  // the last used region
  NvdbNodes::Node head_;                  // of the region's chunk
  std::vector<std::byte> group_;          // the last used group
  std::uint64_t group_at_ = 0;            // in the file; 0: none
};

std::unique_ptr<LeafReader> StoredPackedTree::reader() const { return std::make_unique<PackedBlocks>(*this); }

}  // namespace

std::unique_ptr<LeafTree> make_packed_tree(std::unique_ptr<InputFile> file, const NvdbGrid& grid, bool cached) {
  return std::make_unique<StoredPackedTree>(std::move(file), grid, cached);
}

}  // namespace weir
