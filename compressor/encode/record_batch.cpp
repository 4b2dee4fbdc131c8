#include "compressor/encode/record_batch.h"

#include <span>

namespace weir {

void RecordBatch::add(std::uint64_t ordinal, const LeafValues& decoded, const Box& node, const Box& inside,
                      const DecodedErrors& loss) {
  if (ordinal != first_ + held_.size() + count_) flush();
  if (held_.empty() && count_ == 0) first_ = ordinal;
  values_[count_] = decoded;
  nodes_[count_] = node;
  insides_[count_] = inside;
  losses_[count_] = loss;
  if (++count_ == kLeafBatch) compute();
  if (held_.size() >= kHeldRecords) flush();
}

void RecordBatch::add(std::uint64_t ordinal, const LeafRecord& record) {
  compute();
  if (ordinal != first_ + held_.size()) flush();
  if (held_.empty()) first_ = ordinal;
  held_.push_back(record);
  if (held_.size() >= kHeldRecords) flush();
}

void RecordBatch::flush() {
  compute();
  if (held_.empty()) return;
  records_.write(first_, held_);
  for (std::size_t i = 0; sums_ && i < held_.size(); ++i) sum_ += record_checksum(first_ + i, held_[i]);
  held_.clear();
}

void RecordBatch::compute() {
  if (count_ == 0) return;
  std::array<NodeStatistics, kLeafBatch> statistics;
  full_leaf_statistics({values_.data(), count_}, {nodes_.data(), count_}, std::span(statistics).first(count_));
  for (std::size_t i = 0; i < count_; ++i) {
    if (insides_[i] != nodes_[i]) statistics[i] = leaf_statistics(values_[i], nodes_[i], insides_[i]);
    LeafRecord record = make_leaf_record(values_[i], nodes_[i], insides_[i], statistics[i]);
    record.squared_error = losses_[i].squared;
    record.max_abs = losses_[i].max_abs;
    record.exact = losses_[i].exact ? 1 : 0;
    record.zeros_lost = static_cast<std::uint32_t>(losses_[i].zeros_lost);
    held_.push_back(record);
  }
  count_ = 0;
}

}  // namespace weir
