// Records of kept leaves in the order of their ordinals, their statistics computed a batch at a time and written by the
// thousand.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compressor/encode/leaf_record.h"
#include "compressor/leaf/decoded_errors.h"

namespace weir {

/// One per thread.
class RecordBatch {
 public:
  /// `records` may be null until write_to(); `sums`: whether sum() is asked for.
  explicit RecordBatch(RecordSink* records, bool sums = true) : records_(records), sums_(sums) {}

  /// Where further ones go, after flush(). What an exception has kept from it is dropped: it is not theirs.
  void write_to(RecordSink& records) {
    records_ = &records;
    count_ = 0;
    held_.clear();
    known_ = {};
  }
  void add(std::uint64_t ordinal, const LeafValues& decoded, const Box& node, const Box& inside,
           const DecodedErrors& loss);
  /// One that is known already, and stays until flush().
  void add(std::uint64_t ordinal, const LeafRecord& record);
  /// Writes what is still held.
  void flush();
  /// Of the checksums of all records that were written.
  std::uint64_t sum() const { return sum_; }

 private:
  static constexpr std::size_t kHeldRecords = 1024;

  void compute();
  void write(std::uint64_t first, std::span<const LeafRecord> records);

  RecordSink* records_;
  bool sums_;
  std::size_t count_ = 0;  // leaves whose statistics are not yet computed
  std::array<LeafValues, kLeafBatch> values_{};
  std::array<Box, kLeafBatch> nodes_{};
  std::array<Box, kLeafBatch> insides_{};
  std::array<DecodedErrors, kLeafBatch> losses_{};
  std::uint64_t first_ = 0;  // ordinal of the first record held
  std::vector<LeafRecord> held_;
  std::span<const LeafRecord> known_;  // in the place of held ones, which are written first
  std::uint64_t sum_ = 0;
};

}  // namespace weir
