// Takes the regions of a volume that are encoded one after the other, each as a whole: sums their errors and writes
// their part of the tree while their records are in memory.
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
  /// As TreeWriter, of parts without records. `seen_by`, which may be null: the choices that tell which leaves can be
  /// seen.
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

  // Once all are taken.
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
