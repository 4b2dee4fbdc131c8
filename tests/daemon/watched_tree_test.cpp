// The life of one watch; what it does is seen from outside in watch_*_test.cpp.
#include "daemon/watched_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <thread>

#include "format/base/text.h"
#include "tests/support/temporary_directory.h"

namespace weir::watched_tree_test {
namespace {

// A reload takes a watch away whose timer has ended, but whose turn comes after the reload's.
TEST(WatchedTree, DoesNothingAfterItsDestruction) {
  const TemporaryDirectory directory;
  boost::asio::io_context io;
  JobStore store(directory / "weir.db");
  const EventLog log{ServiceConfig{}};
  WatchConfig watch;
  watch.label = watch.directory = directory / "in";
  watch.output = directory / "out";
  std::filesystem::create_directory(watch.directory);
  const std::int64_t id = store.observe(watch.label, watch.directory + "/gone_2x2x2_uint8.raw", {8, 1, 1}, "").job.id;
  DiskTurns turns(io);
  auto tree =
      std::make_unique<WatchedTree>(io, turns, watch, store, log, WatchedTree::Reports{[] {}, [](std::int64_t) {}});
  boost::asio::post(io, [&] { tree.reset(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  io.poll();
  EXPECT_TRUE(store.job(id).has_value()) << "it looked at its jobs";
}

std::size_t open_descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

TEST(WatchedTree, ManyLargeHierarchies_AreLookedThroughWithFewOpenDirectories) {
  constexpr int kStores = 24;
  constexpr int kFiles = 1100;  // more than are looked at in one turn
  const TemporaryDirectory directory;
  boost::asio::io_context io;
  JobStore store(directory / "weir.db");
  ServiceConfig service;
  service.log_file = directory / "log";
  const EventLog log{service};
  WatchConfig watch;
  watch.label = watch.directory = directory / "in";
  watch.output = directory / "out";
  watch.recursive = true;
  watch.settle_s = 0.1;
  std::ofstream(directory / "chunk") << "1";
  for (int i = 0; i < kStores; ++i) {
    const std::string path = cat(watch.directory, "/s", i, ".zarr");
    std::filesystem::create_directories(path);
    std::ofstream(path + "/.zarray") << "{}";
    for (int n = 0; n < kFiles; ++n) std::filesystem::create_hard_link(directory / "chunk", cat(path, '/', n, ".0.0"));
  }
  DiskTurns turns(io);
  WatchedTree tree(io, turns, watch, store, log, WatchedTree::Reports{[] {}, [](std::int64_t) {}});
  const JobFilter waiting{JobState::waiting, watch.label};
  std::size_t most = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  const std::size_t before = open_descriptors();
  while (store.count(waiting) < kStores && std::chrono::steady_clock::now() < end) {
    io.run_one_for(std::chrono::milliseconds(50));
    most = std::max(most, open_descriptors());
  }
  EXPECT_EQ(store.count(waiting), kStores);
  EXPECT_LE(most, before + 6);  // the watch, a listing, two looks
}

}  // namespace
}  // namespace weir::watched_tree_test
