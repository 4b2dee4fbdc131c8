#include "compressor/select/fixed_bytes.h"

#include "compressor/packed/packed_rule.h"
#include "compressor/select/packed_region.h"
#include "compressor/select/tree_regions.h"
#include "format/layout/tree_layout.h"
#include "format/nanovdb/macrocells.h"

namespace weir {

std::uint64_t region_count(const Box& domain) {
  return static_cast<std::uint64_t>(make_lattice(domain, kLowerDim).size());
}

std::uint64_t fixed_bytes(const Box& domain, Encoding encoding, Preview preview, std::uint64_t asked,
                          std::uint64_t regions) {
  const TreeRegions tree(domain);
  NodeCounts counts;
  counts.root_tiles = tree.uppers.size();
  counts.macrocells = static_cast<std::uint64_t>(make_lattice(domain, kMacrocell).size());
  if (encoding != Encoding::packed) {
    counts.uppers = tree.uppers.size();
    counts.lowers = regions;
    return make_layout(counts).content_end;
  }
  const auto packed = [&](bool with_preview) {
    NodeCounts all = counts;
    set_packed_counts(PackedRule{with_preview, 0}, tree, regions, all);
    all.packed_bytes += regions * kChunkCost;
    return make_layout(all).content_end;
  };
  if (preview != Preview::automatic) return packed(preview == Preview::on);
  const std::uint64_t without = packed(false);
  const std::uint64_t both = packed(true);
  return asked >= kLeastOfPreview * (both - without) ? both : without;
}

}  // namespace weir
