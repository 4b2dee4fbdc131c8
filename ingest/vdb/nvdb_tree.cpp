#include "ingest/vdb/nvdb_tree.h"

#include <array>
#include <cstring>
#include <utility>

#include "format/leaf_decode.h"

namespace weir {
namespace {

class MappedTree final : public LeafTree {
 public:
  MappedTree(FileMapping mapping, NvdbGrid grid, bool cached)
      : mapping_(std::move(mapping)), grid_(std::move(grid)), cached_(cached), pages_(mapping_) {
    mapping_.release_pages();  // what validation has looked at
  }

  std::unique_ptr<LeafReader> reader() const override;
  bool in_memory() const override { return cached_; }
  std::uint64_t working_bytes() const override { return MappedPages::kLimit; }
  std::uint64_t bytes_read() const override { return bytes_read_; }

  void read(const Index3& origin, std::span<std::byte> values) const {
    // A tile is an entry of 8 bytes in the table of a node; with what the kernel maps around it, twice that.
    constexpr std::uint64_t kEntryBytes = 16;
    const GridBlock block = grid_.block_at(origin);
    std::array<float, kLeafVoxels> decoded;
    if (block.leaf == nullptr) {
      pages_.touch(kEntryBytes);
      decoded.fill(block.value);
    } else {
      const std::uint64_t bytes = grid_.type() == GridType::float32
                                      ? nvdb::kFloatLeafBytes
                                      : quantised_leaf_bytes(leaf_bits_log2(grid_.type(), block.leaf));
      pages_.touch(block.leaf, bytes);
      bytes_read_ += bytes;
      grid_.decode_leaf(block.leaf, decoded);
    }
    std::memcpy(values.data(), decoded.data(), sizeof decoded);
  }

 private:
  FileMapping mapping_;
  NvdbGrid grid_;
  bool cached_;
  mutable MappedPages pages_;
  mutable std::atomic<std::uint64_t> bytes_read_{0};
};

class MappedLeaves final : public LeafReader {
 public:
  explicit MappedLeaves(const MappedTree& tree) : tree_(tree) {}
  void read(const Index3& origin, std::span<std::byte> values) override { tree_.read(origin, values); }

 private:
  const MappedTree& tree_;
};

std::unique_ptr<LeafReader> MappedTree::reader() const { return std::make_unique<MappedLeaves>(*this); }

}  // namespace

MappedPages::MappedPages(const FileMapping& mapping)
    : mapping_(mapping), resident_((mapping.bytes().size() + kGranule - 1) / kGranule) {}

void MappedPages::touch(const std::byte* first, std::size_t bytes) {
  const auto begin = static_cast<std::uint64_t>(first - mapping_.bytes().data());
  std::uint64_t added = 0;
  for (std::uint64_t g = begin / kGranule; g <= (begin + bytes - 1) / kGranule; ++g) {
    if (!resident_[g].load(std::memory_order_relaxed) && !resident_[g].exchange(true)) added += kGranule;
  }
  if (added > 0) touch(added);
}

void MappedPages::touch(std::uint64_t bytes) {
  // One of the threads finds the sum beyond the limit first; pages that others look at meanwhile are a few.
  if (bytes_.fetch_add(bytes, std::memory_order_relaxed) + bytes <= kLimit) return;
  if (bytes_.exchange(0) <= kLimit) return;
  for (auto& granule : resident_) granule.store(false, std::memory_order_relaxed);
  mapping_.release_pages();
}

std::unique_ptr<LeafTree> make_nvdb_tree(FileMapping mapping, NvdbGrid grid, bool cached) {
  return std::make_unique<MappedTree>(std::move(mapping), std::move(grid), cached);
}

}  // namespace weir
