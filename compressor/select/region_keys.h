// The sums and keys of the inner levels of the tree: the worth of a 128^3 region or a 4096^3 block as a node, from the
// rows and gains of its leaves.
#pragma once

#include <cstdint>
#include <optional>

#include "compressor/select/leaf_gain.h"
#include "compressor/select/region_rows.h"
#include "compressor/select/tree_regions.h"

namespace weir {

/// Fills the entries of `tree`. The tree and the rule must outlive the object.
class RegionKeys {
 public:
  RegionKeys(const GainRule& rule, TreeRegions& tree) : rule_(rule), tree_(tree) {}

  /// Sets the region's sums, tile error, opening gain and key, its reach if a scene weighs errors, and its packed value
  /// and means. `rows` and `gains` belong to its leaves. Thread-safe for different regions.
  void summarize_region(std::int64_t index, const RegionRows& rows, const RegionGains& gains);
  /// Sets the same for all upper nodes, from their regions.
  void summarize_uppers();

 private:
  void summarize_upper(std::int64_t index);
  TileSumsBuilder sums_to_mean(std::int64_t upper) const;
  void set_key(Upper& upper, double tiles, bool seen, bool exceeded) const;
  double weigh_region(Region& region, const RegionRows& rows, float tile, std::optional<float> shared_value) const;
  bool sees(const Region& region, float tile) const;
  bool exceeds(double max_error, const Region& region, float tile) const;

  const GainRule& rule_;
  TreeRegions& tree_;
};

}  // namespace weir
