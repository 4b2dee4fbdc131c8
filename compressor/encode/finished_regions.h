// Takes the regions of a volume that is encoded region by region. Sums the errors of each region and writes its part of
// the tree while its records are still in memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compressor/encode/layer_encoder.h"
#include "compressor/encode/leaf_errors.h"
#include "compressor/encode/tree_writer.h"

namespace weir {

class FinishedRegions final : public RegionSink {
 public:
  /// `parts` and `out` are as in TreeWriter; `parts` has no records. `seen_by` may be null; otherwise its choices tell
  /// which leaves can be seen.
  FinishedRegions(const TreeParts& parts, File& out, const ChoiceStore* seen_by)
      : seen_by_(seen_by), errors_(parts.tree.regions.size()), seen_errors_(errors_.size()), tree_(parts, out) {}

  void take(std::int64_t region, std::span<const LeafRecord> records) override {
    const auto i = static_cast<std::size_t>(region);
    errors_[i] = seen_errors_[i] = sum_region_errors(records);
    if (seen_by_ != nullptr) {
      const LeafChoices choices = seen_by_->read(region);
      seen_errors_[i] = sum_region_errors(records, &choices);
    }
    tree_.add(region, records);
  }

  // Call errors() and seen_errors() after all regions are taken.
  DecodedErrors errors() const { return sum_errors(errors_); }
  DecodedErrors seen_errors() const { return sum_errors(seen_errors_); }
  TreeWriter& tree() { return tree_; }

 private:
  const ChoiceStore* seen_by_;
  std::vector<DecodedErrors> errors_;  // by region
  std::vector<DecodedErrors> seen_errors_;
  TreeWriter tree_;
};

}  // namespace weir
