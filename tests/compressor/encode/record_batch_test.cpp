#include "compressor/encode/record_batch.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <utility>
#include <vector>

#include "tests/compressor/support/crash_file_system.h"

namespace weir::record_batch_test {
namespace {

TEST(RecordBatch, WritesWhatEachLeafAloneGives) {
  constexpr std::uint64_t kRecords = 3000;
  RecordStore store(test::CrashFileSystem().create_unnamed("records"), kRecords);
  RecordBatch batch(&store);
  std::mt19937 random(5);
  std::vector<std::pair<std::uint64_t, LeafRecord>> expected;
  for (std::uint64_t ordinal = 0; ordinal < kRecords; ++ordinal) {
    if (ordinal % 11 == 7 || (ordinal > 40 && ordinal < 60)) continue;  // another thread's
    LeafValues values;
    for (float& v : values) v = static_cast<float>(random() % 1000);
    const Index3 lo{static_cast<std::int64_t>(ordinal) * 8, 0, 8};
    const Box node{lo, lo + Index3{8, 8, 8}};
    const Box inside = ordinal % 5 == 0 ? Box{lo, lo + Index3{3, 8, 5}} : node;
    const DecodedErrors loss{static_cast<double>(ordinal), 0.5, ordinal % 2 == 0 ? Kept::all : Kept::values, 0};
    batch.add(ordinal, values, node, inside, loss);
    LeafRecord record = make_leaf_record(values, node, inside, leaf_statistics(values, node, inside));
    record.squared_error = loss.squared;
    record.max_abs = loss.max_abs;
    record.kept = loss.kept;
    expected.emplace_back(ordinal, record);
  }
  batch.flush();
  for (const auto& [ordinal, record] : expected) {
    const LeafRecord found = store.read(ordinal, 1)[0];
    ASSERT_EQ(std::memcmp(&found, &record, sizeof record), 0) << ordinal;
  }
}

// Some records are computed, others are known. Of the known ones, some are adjacent in memory and some are not.
TEST(RecordBatch, WritesKnownRecordsAmongOthers) {
  constexpr std::uint64_t kRecords = 500;
  RecordStore store(test::CrashFileSystem().create_unnamed("records"), kRecords);
  RecordBatch batch(&store);
  std::vector<LeafRecord> known(2 * kRecords);
  std::vector<LeafRecord> expected(kRecords);
  std::vector<bool> added(kRecords);
  std::size_t next = 0;
  std::uint64_t sum = 0;
  for (std::uint64_t ordinal = 0; ordinal < kRecords; ++ordinal) {
    if (ordinal % 50 == 49) continue;  // another thread's
    added[ordinal] = true;
    LeafRecord& record = expected[ordinal];
    const auto value = static_cast<float>(ordinal);
    if (ordinal % 13 < 10) {
      if (ordinal % 7 == 3) ++next;  // a gap in memory
      LeafRecord& of_coder = known[next++];
      of_coder.mean = value;
      of_coder.bounds = {value, value + 1};
      record = of_coder;
      batch.add(ordinal, of_coder);
    } else {
      LeafValues values;
      values.fill(value);
      const Box node{{0, 0, 0}, {8, 8, 8}};
      batch.add(ordinal, values, node, node, {1, 0.5, Kept::lossy, 0});
      record = make_leaf_record(values, node, node, leaf_statistics(values, node, node));
      record.squared_error = 1;
      record.max_abs = 0.5;
      record.kept = Kept::lossy;
    }
    sum += record_checksum(ordinal, record);
  }
  batch.flush();
  for (std::uint64_t ordinal = 0; ordinal < kRecords; ++ordinal) {
    if (!added[ordinal]) continue;
    const LeafRecord found = store.read(ordinal, 1)[0];
    ASSERT_EQ(std::memcmp(&found, &expected[ordinal], sizeof found), 0) << ordinal;
  }
  EXPECT_EQ(batch.sum(), sum);
}

// An exception keeps a thread's records from being flushed. The thread may still get the next region.
TEST(RecordBatch, DropsWhatWasNotFlushedWhereFurtherRecordsGoElsewhere) {
  std::vector<LeafRecord> known(3);
  known[0].mean = 5;
  known[2].mean = 7;
  LeafValues values;
  values.fill(3);
  const Box node{{0, 0, 0}, {8, 8, 8}};
  for (const bool knows : {true, false}) {
    SCOPED_TRACE(knows);
    RecordStore first(test::CrashFileSystem().create_unnamed("records"), 4);
    RecordStore second(test::CrashFileSystem().create_unnamed("records"), 4);
    RecordBatch batch(&first);
    knows ? batch.add(0, known[0]) : batch.add(0, values, node, node, {});
    batch.write_to(second);
    batch.add(2, known[2]);
    batch.flush();
    EXPECT_EQ(first.read(0, 1).front().mean, 0);
    EXPECT_EQ(second.read(0, 1).front().mean, 0);
    EXPECT_EQ(second.read(2, 1).front().mean, 7);
  }
}

}  // namespace
}  // namespace weir::record_batch_test
