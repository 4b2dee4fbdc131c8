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
  RecordBatch batch(store);
  std::mt19937 random(5);
  std::vector<std::pair<std::uint64_t, LeafRecord>> expected;
  for (std::uint64_t ordinal = 0; ordinal < kRecords; ++ordinal) {
    if (ordinal % 11 == 7 || (ordinal > 40 && ordinal < 60)) continue;  // another thread's
    LeafValues values;
    for (float& v : values) v = static_cast<float>(random() % 1000);
    const Index3 lo{static_cast<std::int64_t>(ordinal) * 8, 0, 8};
    const Box node{lo, lo + Index3{8, 8, 8}};
    const Box inside = ordinal % 5 == 0 ? Box{lo, lo + Index3{3, 8, 5}} : node;
    const DecodedErrors loss{static_cast<double>(ordinal), 0.5, ordinal % 2 == 0};
    batch.add(ordinal, values, node, inside, loss);
    LeafRecord record = make_leaf_record(values, node, inside, leaf_statistics(values, node, inside));
    record.squared_error = loss.squared;
    record.max_abs = loss.max_abs;
    record.exact = loss.exact ? 1 : 0;
    expected.emplace_back(ordinal, record);
  }
  batch.flush();
  for (const auto& [ordinal, record] : expected) {
    const LeafRecord found = store.read(ordinal, 1)[0];
    ASSERT_EQ(std::memcmp(&found, &record, sizeof record), 0) << ordinal;
  }
}

}  // namespace
}  // namespace weir::record_batch_test
