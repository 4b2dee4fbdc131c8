#include "ingest/vdb/nvdb_leaf_tree.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/layout/nanovdb_layout.h"
#include "format/leaf/leaf_decode.h"

namespace weir {
namespace {

using RootKey = std::array<std::int64_t, 3>;

// An entry of the root's table.
struct RootPlace {
  std::uint64_t upper = 0;  // offset in the file; 0: a tile
  float value = 0;
};

class StoredNvdbTree final : public LeafTree {
 public:
  StoredNvdbTree(std::unique_ptr<InputFile> file, const NvdbGrid& grid, bool cached)
      : file_(std::move(file)),
        nodes_(*file_, grid.grid_offset(), grid.grid_offset() + grid.data_bytes()),
        type_(grid.type()),
        background_(grid.background()),
        root_at_(grid.grid_offset() + nvdb::kRootOffset),
        cached_(cached) {
    grid.for_each_root_entry([&](const RootEntry& entry) {
      const auto upper = entry.upper == nullptr ? 0 : static_cast<std::uint64_t>(entry.upper - grid.bytes().data());
      root_.try_emplace(key_of(entry.origin), RootPlace{upper, entry.value});  // the first entry of a place counts
    });
  }

  std::unique_ptr<LeafReader> reader() const override;
  bool in_memory() const override { return cached_; }
  std::uint64_t working_bytes() const override { return NvdbNodes::kLimit + root_.size() * kRootEntryBytes; }
  std::uint64_t bytes_read() const override { return file_->bytes_read(); }

  // Returns null if the root has no entry.
  const RootPlace* root_place(const Index3& upper_origin) const {
    const auto found = root_.find(key_of(upper_origin));
    return found == root_.end() ? nullptr : &found->second;
  }
  float background() const { return background_; }
  std::uint64_t root_at() const { return root_at_; }
  NvdbNodes& nodes() const { return nodes_; }

  // Reads the leaf at offset `at`, to which the node at `from` points.
  void read_leaf(std::uint64_t at, std::uint64_t from, std::span<float> values) const {
    std::array<std::byte, nvdb::kFloatLeafBytes> leaf;
    if (type_ == GridType::float32) {
      nodes_.check(at, nvdb::kFloatLeafBytes, from);
      file_->read_buffered(at, leaf, ReadPath::cache);
      std::memcpy(values.data(), leaf.data() + nvdb::leaf::kValues, values.size_bytes());
      return;
    }
    // The leaf's head says how long the leaf is. One read takes the most bytes that a leaf may have; the checks follow.
    nodes_.check(at, nvdb::kLeafHeadBytes, from);
    const std::uint64_t most = type_ == GridType::fpn ? quantised_leaf_bytes(kMaxLeafBitsLog2)
                                                      : quantised_leaf_bytes(leaf_bits_log2(type_, leaf.data()));
    const std::uint64_t bytes = std::min(most, nodes_.end() - at);
    file_->read_buffered(at, std::span(leaf).first(bytes), ReadPath::cache);
    if (type_ == GridType::fpn && fpn_bits_log2(leaf.data()) > kMaxLeafBitsLog2) {
      throw input_error(file_->path(), cat("at byte ", at + nvdb::leaf::kFlags, ": log2 of the FpN leaf's width is ",
                                           fpn_bits_log2(leaf.data()), ", at most ", kMaxLeafBitsLog2));
    }
    const unsigned bits_log2 = leaf_bits_log2(type_, leaf.data());
    nodes_.check(at, quantised_leaf_bytes(bits_log2), from);
    const auto quantum = weir::load<float>(leaf.data() + nvdb::leaf::kQuantum);
    const auto minimum = weir::load<float>(leaf.data() + nvdb::leaf::kQuantMinimum);
    for (unsigned i = 0; i < values.size(); ++i) {
      values[i] = dequantize(leaf_code(leaf.data() + nvdb::leaf::kCodes, bits_log2, i), quantum, minimum);
    }
  }

 private:
  static constexpr std::uint64_t kRootEntryBytes = 96;  // with a map's node around it

  static RootKey key_of(const Index3& i) { return {i.x, i.y, i.z}; }

  std::unique_ptr<InputFile> file_;
  mutable NvdbNodes nodes_;
  GridType type_;
  float background_;
  std::uint64_t root_at_;
  bool cached_;
  std::map<RootKey, RootPlace> root_;
};

// An inner node and its offset.
struct InnerNode {
  NvdbNodes::Node bytes;
  std::uint64_t at = 0;

  const std::byte* data() const { return bytes->data(); }
};

class NvdbLeaves final : public LeafReader {
 public:
  explicit NvdbLeaves(const StoredNvdbTree& tree) : tree_(tree) {}

  void read(const Index3& origin, std::span<std::byte> values) override {
    std::array<float, kLeafVoxels> decoded;
    find(origin, decoded);
    std::memcpy(values.data(), decoded.data(), sizeof decoded);
  }

 private:
  // Returns the index of a voxel's entry in a node's table. An entry has an edge of `dim` voxels; a node has `side`
  // entries along an edge.
  static std::size_t entry_of(const Index3& i, std::int64_t dim, std::int64_t side) {
    const auto axis = [&](std::int64_t v) { return floor_div(v, dim) & (side - 1); };
    return static_cast<std::size_t>((axis(i.x) * side + axis(i.y)) * side + axis(i.z));
  }
  static bool has_child(const InnerNode& node, const nvdb::InternalLayout& layout, std::size_t entry) {
    const auto byte = std::to_integer<unsigned>(node.data()[layout.child_mask + entry / 8]);
    return ((byte >> (entry % 8)) & 1U) != 0;
  }
  static float tile(const InnerNode& node, const nvdb::InternalLayout& layout, std::size_t entry) {
    return weir::load<float>(node.data() + layout.table + 8 * entry);
  }
  // The offset may wrap around in a damaged file. Every caller checks the offset before it reads there.
  static std::uint64_t child(const InnerNode& node, const nvdb::InternalLayout& layout, std::size_t entry) {
    return node.at + weir::load<std::uint64_t>(node.data() + layout.table + 8 * entry);
  }

  static void fill(std::span<float> values, float value) { std::ranges::fill(values, value); }

  void hold(InnerNode& held, std::uint64_t at, std::uint64_t bytes, std::uint64_t from) const {
    if (held.bytes && held.at == at) return;
    held = {tree_.nodes().read(at, bytes, from), at};
  }

  void find(const Index3& i, std::span<float> values) {
    const RootPlace* const place = tree_.root_place(floor_div(i, kUpperDim) * kUpperDim);
    if (place == nullptr) return fill(values, tree_.background());
    if (place->upper == 0) return fill(values, place->value);
    hold(upper_, place->upper, nvdb::kUpperBytes, tree_.root_at());
    const std::size_t u = entry_of(i, kLowerDim, kUpperLowers);
    if (!has_child(upper_, nvdb::kUpper, u)) return fill(values, tile(upper_, nvdb::kUpper, u));
    hold(lower_, child(upper_, nvdb::kUpper, u), nvdb::kLowerBytes, upper_.at);
    const std::size_t l = entry_of(i, kLeafDim, kLowerLeaves);
    if (!has_child(lower_, nvdb::kLower, l)) return fill(values, tile(lower_, nvdb::kLower, l));
    tree_.read_leaf(child(lower_, nvdb::kLower, l), lower_.at, values);
  }

  const StoredNvdbTree& tree_;
  InnerNode upper_;  // the last used node of each kind
  InnerNode lower_;
};

std::unique_ptr<LeafReader> StoredNvdbTree::reader() const { return std::make_unique<NvdbLeaves>(*this); }

}  // namespace

void NvdbNodes::check(std::uint64_t at, std::uint64_t bytes, std::uint64_t from) const {
  if (at >= begin_ && at <= end_ && bytes <= end_ - at) return;
  throw input_error(file_.path(), cat("at byte ", from, ": a node points to byte ", at, ", and the grid lies in bytes ",
                                      begin_, " to ", end_, "; it is damaged or was rewritten while it was read"));
}

NvdbNodes::Node NvdbNodes::read(std::uint64_t at, std::uint64_t bytes, std::uint64_t from) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = places_.find(at); found != places_.end() && found->second->second->size() == bytes) {
      nodes_.splice(nodes_.begin(), nodes_, found->second);
      return found->second->second;
    }
  }
  check(at, bytes, from);
  auto fresh = std::make_shared<std::vector<std::byte>>(bytes);
  file_.read_buffered(at, *fresh, ReadPath::cache);
  const std::lock_guard lock(mutex_);
  if (const auto found = places_.find(at); found != places_.end()) {  // another thread was faster
    held_ -= found->second->second->size();
    nodes_.erase(found->second);
    places_.erase(found);
  }
  nodes_.emplace_front(at, fresh);
  places_[at] = nodes_.begin();
  held_ += bytes;
  while (held_ > kLimit) {
    held_ -= nodes_.back().second->size();
    places_.erase(nodes_.back().first);
    nodes_.pop_back();
  }
  return fresh;
}

std::unique_ptr<LeafTree> make_nvdb_leaf_tree(std::unique_ptr<InputFile> file, const NvdbGrid& grid, bool cached) {
  return std::make_unique<StoredNvdbTree>(std::move(file), grid, cached);
}

}  // namespace weir
