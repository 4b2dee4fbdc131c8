#include "compressor/encode/record_batch.h"

#include <span>

namespace weir {

void RecordBatch::add(std::uint64_t ordinal, const LeafValues& decoded, const Box& node, const Box& inside,
                      const DecodedErrors& loss) {
  if (!known_.empty() || ordinal != first_ + held_.size() + count_) flush();
  if (held_.empty() && count_ == 0) first_ = ordinal;
  values_[count_] = decoded;
  nodes_[count_] = node;
  insides_[count_] = inside;
  losses_[count_] = loss;
  if (++count_ == kLeafBatch) compute();
  if (held_.size() >= kHeldRecords) flush();
}

void RecordBatch::add(std::uint64_t ordinal, const LeafRecord& record) {
  const bool follows = !known_.empty() && ordinal == first_ + known_.size() && &record == known_.data() + known_.size();
  if (!follows) {
    flush();
    first_ = ordinal;
    known_ = {&record, 0};
  }
  known_ = {known_.data(), known_.size() + 1};
}

void RecordBatch::flush() {
  compute();
  write(first_, known_.empty() ? held_ : known_);
  known_ = {};
  held_.clear();
}

void RecordBatch::write(std::uint64_t first, std::span<const LeafRecord> records) {
  if (records.empty()) return;
  records_->write(first, records);
  for (std::size_t i = 0; sums_ && i < records.size(); ++i) sum_ += record_checksum(first + i, records[i]);
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
    record.kept = losses_[i].kept;
    record.zeros_lost = static_cast<std::uint32_t>(losses_[i].zeros_lost);
    held_.push_back(record);
  }
  count_ = 0;
}

}  // namespace weir
