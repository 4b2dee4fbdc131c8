// Tests which pipelines of filters weir undoes itself, and how it undoes them.
#include "ingest/hdf5/filters/filter_pipeline.h"

#include <functional>
#include <vector>

#include "ingest/hdf5/filters/undo_filters.h"
#include "tests/ingest/support/scratch.h"
#include "tests/support/sanitized.h"

namespace weir::filter_pipeline_test {
namespace {

std::optional<FilterPipeline> pipeline_after(const std::function<void(hid_t)>& set_filters) {
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  set_filters(creation);
  auto pipeline = own_pipeline(creation);
  H5Pclose(creation);
  return pipeline;
}

TEST(FilterPipeline, SupportedFiltersAreListedInOrder) {
  const LeaksOfLibraries of_plugins;  // the library searches its plugins for the filter
  EXPECT_TRUE(pipeline_after([](hid_t) {}).value().empty());
  const auto all = pipeline_after([](hid_t p) {
    H5Pset_fletcher32(p);
    const unsigned value_bytes = 8;  // the library sets this when it creates a dataset
    H5Pset_filter(p, H5Z_FILTER_SHUFFLE, 0, 1, &value_bytes);
    H5Pset_deflate(p, 9);
  });
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 3U);
  EXPECT_EQ((*all)[0].kind, FilterKind::fletcher32);
  EXPECT_EQ((*all)[1].kind, FilterKind::shuffle);
  EXPECT_EQ((*all)[1].value_bytes, 8U);
  EXPECT_EQ((*all)[2].kind, FilterKind::deflate);
  const auto lzf = pipeline_after([](hid_t p) { H5Pset_filter(p, 32000, H5Z_FLAG_OPTIONAL, 0, nullptr); });
  ASSERT_TRUE(lzf);
  EXPECT_EQ(lzf->at(0).kind, FilterKind::lzf);
}

TEST(FilterPipeline, UnsupportedFiltersAreLeftToTheLibrary) {
  const LeaksOfLibraries of_plugins;  // the library searches its plugins for the filter
  EXPECT_FALSE(pipeline_after([](hid_t p) { H5Pset_nbit(p); }));
  EXPECT_FALSE(pipeline_after([](hid_t p) { H5Pset_scaleoffset(p, H5Z_SO_INT, 0); }));
  EXPECT_FALSE(pipeline_after([](hid_t p) {
    H5Pset_deflate(p, 1);
    H5Pset_filter(p, 32015, H5Z_FLAG_OPTIONAL, 0, nullptr);  // Zstandard
  }));
  EXPECT_FALSE(pipeline_after([](hid_t p) {
    const unsigned level = 1;
    H5Pset_deflate(p, 1);
    H5Pset_filter(p, H5Z_FILTER_DEFLATE, 0, 1, &level);
  })) << "deflate twice";
  EXPECT_FALSE(pipeline_after([](hid_t p) {
    H5Pset_deflate(p, 1);
    H5Pset_filter(p, 32000, H5Z_FLAG_OPTIONAL, 0, nullptr);
  })) << "deflate and lzf";
  // The file states values of 0 bytes, by which nothing may be divided.
  EXPECT_FALSE(pipeline_after([](hid_t p) {
    const unsigned value_bytes = 0;
    H5Pset_filter(p, H5Z_FILTER_SHUFFLE, 0, 1, &value_bytes);
  }));
  EXPECT_FALSE(own_pipeline(H5I_INVALID_HID));
}

TEST(FilterPipeline, GivesTheStoredSizeBoundAndBufferNeed) {
  const FilterPipeline none;
  EXPECT_EQ(most_stored_bytes(none, 1000), 1000U);
  EXPECT_FALSE(needs_other_buffer(none));
  const FilterPipeline checked{{FilterKind::fletcher32}};
  EXPECT_EQ(most_stored_bytes(checked, 1000), 1004U);
  EXPECT_FALSE(needs_other_buffer(checked));
  const FilterPipeline packed{{FilterKind::shuffle, 4}, {FilterKind::deflate}, {FilterKind::fletcher32}};
  EXPECT_EQ(most_stored_bytes(packed, 1000), 1000U + 3 + 64 + 4);
  EXPECT_TRUE(needs_other_buffer(packed));
}

/// Returns the result of undo_filters() on `stored`. The buffers have the smallest size that is allowed.
std::vector<std::byte> undone(const FilterPipeline& pipeline, FilterMask left_out, std::size_t chunk_bytes,
                              const std::vector<std::byte>& stored) {
  std::vector<std::byte> buffer(most_stored_bytes(pipeline, chunk_bytes));
  std::vector<std::byte> other(needs_other_buffer(pipeline) ? buffer.size() : 0);
  std::copy(stored.begin(), stored.end(), buffer.begin());
  ChunkInflater inflater;
  const auto bytes = undo_filters(pipeline, left_out, chunk_bytes, stored.size(), buffer, other, inflater);
  return {bytes.begin(), bytes.end()};
}

TEST(FilterPipeline, TheMaskLeavesFiltersOut) {
  const FilterPipeline pipeline{{FilterKind::shuffle, 2}, {FilterKind::deflate}, {FilterKind::fletcher32}};
  const std::vector<std::byte> values{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}};
  const std::vector<std::byte> planes{std::byte{1}, std::byte{3}, std::byte{2}, std::byte{4}};
  EXPECT_EQ(undone(pipeline, kAllLeftOut, 4, values), values);
  EXPECT_EQ(undone(pipeline, 0b110, 4, planes), values);
  std::vector<std::byte> checked = planes;
  const std::uint32_t sum = fletcher32(planes);
  for (int i = 0; i < 4; ++i) checked.push_back(static_cast<std::byte>(sum >> (8 * i)));
  EXPECT_EQ(undone(pipeline, 0b010, 4, checked), values);
  EXPECT_EQ(undone(pipeline, 0b011, 4, checked), planes);
}

TEST(FilterPipeline, ChunksOfTheWrongSizeAreRefused) {
  const FilterPipeline pipeline{{FilterKind::shuffle, 2}, {FilterKind::fletcher32}};
  const auto message = [&](FilterMask left_out, const std::vector<std::byte>& stored) {
    return message_of_error(ErrorKind::input, [&] { undone(pipeline, left_out, 8, stored); });
  };
  EXPECT_EQ(message(kAllLeftOut, std::vector<std::byte>(7)), "holds 7 bytes, not 8");
  EXPECT_EQ(message(kAllLeftOut, std::vector<std::byte>(9)), "holds 9 bytes, not 8");
  EXPECT_EQ(message(0, std::vector<std::byte>(8)), "holds 4 bytes, not 8");
  EXPECT_EQ(message(0, {}), "holds 0 bytes, fewer than its checksum takes");
}

}  // namespace
}  // namespace weir::filter_pipeline_test
