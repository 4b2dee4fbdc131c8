// Collects the records of kept leaves in the order of their ordinals. Computes their statistics in batches and writes
// the records by the thousand.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compressor/encode/leaf_record.h"
#include "compressor/leaf/decoded_errors.h"

namespace weir {

/// One object per thread.
class RecordBatch {
 public:
  /// `records` receives the records; it may be null until write_to(). `sums` says whether sum() will be called.
  explicit RecordBatch(RecordSink* records, bool sums = true) : records_(records), sums_(sums) {}

  /// Sends further records to `records`. Call it after flush(). Drops records that an exception kept from being
  /// flushed: they do not belong to `records`.
  void write_to(RecordSink& records) {
    records_ = &records;
    count_ = 0;
    held_.clear();
    known_ = {};
  }
  void add(std::uint64_t ordinal, const LeafValues& decoded, const Box& node, const Box& inside,
           const DecodedErrors& loss);
  /// Adds a finished record, which must stay where it is until flush().
  void add(std::uint64_t ordinal, const LeafRecord& record);
  /// Writes what is still held.
  void flush();
  /// Returns the sum of the checksums of all written records.
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
  std::span<const LeafRecord> known_;  // finished records to write; while it is not empty, held_ is empty
  std::uint64_t sum_ = 0;
};

}  // namespace weir
