// Tests Zarr hierarchies in directories below a watched one, with the real `weir watch`. Each is one input and is
// converted when nothing in it changes any more.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "format/base/text.h"
#include "tests/daemon/support/service_harness.h"
#include "tests/support/file_tick.h"

namespace weir::watch_zarr_test {
namespace {

namespace fs = std::filesystem;

constexpr int kChunks = 4;

/// Writes the metadata of an array of 8 * `chunks` x 16 x 16 bytes in the directory `store`, in version 2 or 3.
void begin(const std::string& store, int version, int chunks = kChunks) {
  fs::create_directories(store);
  const std::string shape = cat("[", 8 * chunks, ", 16, 16]");
  if (version == 2) {
    std::ofstream(store + "/.zarray") << R"({"zarr_format": 2, "shape": )" << shape << R"(, "chunks": [8, 16, 16], )"
                                      << R"("dtype": "|u1", "compressor": null, "fill_value": 0, "order": "C", )"
                                      << R"("filters": null})";
    return;
  }
  std::ofstream(store + "/zarr.json")
      << R"({"zarr_format": 3, "node_type": "array", "shape": )" << shape << R"(, "data_type": "uint8", )"
      << R"("chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [8, 16, 16]}}, )"
      << R"("chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}}, )"
      << R"("fill_value": 0, "codecs": [{"name": "bytes"}], "attributes": {}})";
}

void add_chunk(const std::string& store, int version, int chunk) {
  const std::string path = version == 2 ? cat(store, '/', chunk, ".0.0") : cat(store, "/c/", chunk, "/0/0");
  fs::create_directories(fs::path(path).parent_path());
  std::string values(8 * 16 * 16, '\0');
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<char>(1 + chunk + static_cast<int>(i % 7));
  std::ofstream(path, std::ios::binary) << values;
}

std::string keys(const std::string& method, const std::string& more = "settle = 2\n") {
  return cat("watch = \"", method, "\"\nrecursive = true\nlossless = true\n", more);
}

/// watch = "inotify" (which polls nothing) and watch = "poll" (which opens no inotify).
class WatchZarr : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(, WatchZarr, testing::Values("inotify", "poll"),
                         [](const auto& method) { return std::string(method.param); });

TEST_P(WatchZarr, AStoreThatGrowsSlowly_IsConvertedOnceAndWhole) {
  ServiceHarness service("", keys(GetParam()));
  service.start();
  for (const int version : {2, 3}) begin(service.in(cat("v", version, ".zarr")), version);
  for (int chunk = 0; chunk < kChunks; ++chunk) {
    for (const int version : {2, 3}) add_chunk(service.in(cat("v", version, ".zarr")), version, chunk);
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    EXPECT_EQ(service.logged(" start "), 0U) << "before chunk " << chunk + 1 << '\n' << service.log();
  }
  ASSERT_TRUE(service.eventually_done(2)) << service.log();
  EXPECT_EQ(service.difference("v2.zarr", "v2.nvdb", {"--lossless"}), "");
  EXPECT_EQ(service.difference("v3.zarr", "v3.nvdb", {"--lossless"}), "");
  EXPECT_EQ(service.logged(" start "), 2U);
  EXPECT_EQ(service.leftovers(), std::vector<std::string>{});
}

TEST_P(WatchZarr, WithMarkers_WaitsForTheMarker) {
  ServiceHarness service("", keys(GetParam(), "complete = \"marker\"\n"));
  service.start();
  const std::string store = service.in("a.zarr");
  begin(store, 3);
  for (int chunk = 0; chunk < kChunks; ++chunk) add_chunk(store, 3, chunk);
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  EXPECT_EQ(service.logged(" start "), 0U) << service.log();
  std::ofstream(store + "/zarr.json.done") << "";
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.difference("a.zarr", "a.nvdb", {"--lossless"}), "");
}

TEST(WatchZarrDeletion, AStoreWhoseMetadataAreItsNewestFile_IsKeptWhole) {
  ServiceHarness service("", keys("inotify", "settle = 0.2\nsource = \"delete-after-verify\"\ndelete_after = 0.1\n"));
  for (const int version : {2, 3}) {
    const std::string store = service.in(cat("v", version, ".zarr"));
    for (int chunk = 0; chunk < kChunks; ++chunk) add_chunk(store, version, chunk);
    pass_file_tick();
    begin(store, version);
  }
  service.start();
  ASSERT_TRUE(service.eventually_done(2)) << service.log();
  ASSERT_TRUE(ServiceHarness::eventually([&] {
    return service.logged(" not-deleted ") + service.logged(" deleted ") == 2;
  })) << service.log();
  EXPECT_EQ(service.logged(" deleted "), 0U) << service.log();
  EXPECT_TRUE(fs::exists(service.in("v2.zarr/.zarray")));
  EXPECT_TRUE(fs::exists(service.in("v3.zarr/zarr.json")));
}

TEST(WatchZarrAgain, AStoreThatIsAppendedTo_IsConvertedAgain) {
  ServiceHarness service("", keys("inotify", "settle = 0.3\n"));
  const std::string store = service.in("a.zarr");
  begin(store, 3);
  for (int chunk = 0; chunk < kChunks; ++chunk) add_chunk(store, 3, chunk);
  service.start();
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  add_chunk(store, 3, kChunks);
  begin(store, 3, kChunks + 1);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" start ") == 2; })) << service.log();
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.difference("a.zarr", "a.nvdb", {"--lossless"}), "");
}

/// Writes a group of version 2 with one array, density, of `steps` steps of 8 x 16 x 16 bytes. Only the last step is
/// written again.
void write_steps(const std::string& group, int steps) {
  const std::string array = group + "/density";
  fs::create_directories(array);
  if (!fs::exists(group + "/.zgroup")) std::ofstream(group + "/.zgroup") << R"({"zarr_format": 2})";
  std::string values(8 * 16 * 16, '\0');
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<char>(static_cast<int>(i % 11) * steps);
  std::ofstream(cat(array, '/', steps - 1, ".0.0.0"), std::ios::binary) << values;
  std::ofstream(array + "/.zarray") << R"({"zarr_format": 2, "shape": [)" << steps
                                    << R"(, 8, 16, 16], "chunks": [1, 8, 16, 16], "dtype": "|u1", )"
                                    << R"("compressor": null, "fill_value": 0, "order": "C", "filters": null})";
}

TEST_P(WatchZarr, AStepAppendedToAnArrayOfAGroup_IsConvertedWhileItRunsAndAfterARestart) {
  ServiceHarness service("", keys(GetParam(), "settle = 0.3\ndataset = \"density\"\nindex = \"-1\"\n"));
  const std::string group = service.in("run.zarr");
  const auto expect_converted = [&](std::size_t times) {
    ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" start ") == times; })) << service.log();
    ASSERT_TRUE(service.eventually_done(1)) << service.log();
    EXPECT_EQ(service.difference("run.zarr", "run.nvdb", {"--lossless", "--dataset=density", "--index=-1"}), "");
  };
  write_steps(group, 1);
  service.start();
  expect_converted(1);
  write_steps(group, 2);
  expect_converted(2);
  service.stop();
  write_steps(group, 3);
  service.start();
  expect_converted(3);
}

}  // namespace
}  // namespace weir::watch_zarr_test
