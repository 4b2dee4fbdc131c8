#include "tools/export/export_tree.h"

#include "format/leaf/leaf_decode.h"

namespace weir {
namespace {

// Reads the nodes that the file stores.
class StoredExportTree final : public ExportTree {
 public:
  explicit StoredExportTree(const NvdbGrid& grid) : grid_(grid) {}

  std::vector<ExportRoot> roots() const override {
    std::vector<ExportRoot> all;
    grid_.for_each_root_entry([&](const RootEntry& entry) {
      all.push_back({entry.origin, entry.upper != nullptr, {entry.upper, entry.origin}, entry.active, entry.value});
    });
    return all;
  }
  void read_upper(const ExportNode& upper, UpperNode& node) const override { read(upper.at, nvdb::kUpper, node); }
  void read_lower(const ExportNode& lower, LowerNode& node) const override { read(lower.at, nvdb::kLower, node); }
  ExportNode lower_of(const ExportNode& upper, std::size_t entry) const override {
    return {child_of(upper.at, nvdb::kUpper, entry), {}};
  }
  ExportNode leaf_of(const ExportNode& lower, std::size_t entry) const override {
    return {child_of(lower.at, nvdb::kLower, entry), {}};
  }
  NodeMask<kLeafVoxels> leaf_mask(const ExportNode& leaf) const override {
    return load<NodeMask<kLeafVoxels>>(leaf.at + nvdb::leaf::kValueMask);
  }
  void read_leaf(const ExportNode& leaf, std::span<float, 512> values) const override {
    grid_.decode_leaf(leaf.at, values);
  }
  std::uint64_t leaves() const override { return grid_.node_counts()[0]; }

 private:
  static const std::byte* child_of(const std::byte* node, const nvdb::InternalLayout& layout, std::size_t entry) {
    return node + load<std::int64_t>(node + layout.table + 8 * entry);
  }

  template <std::size_t Entries>
  static void read(const std::byte* at, const nvdb::InternalLayout& layout, InternalNode<Entries>& node) {
    node.children = load<NodeMask<Entries>>(at + layout.child_mask);
    node.active = load<NodeMask<Entries>>(at + layout.value_mask);
    for (std::size_t i = 0; i < Entries; ++i) {
      const bool child = (node.children[i / 64] >> i % 64 & 1U) != 0;
      node.values[i] = child ? 0.0F : load<float>(at + layout.table + 8 * i);
    }
  }

  const NvdbGrid& grid_;
};

}  // namespace

std::unique_ptr<ExportTree> make_stored_export_tree(const NvdbGrid& grid) {
  return std::make_unique<StoredExportTree>(grid);
}

}  // namespace weir
