// The life of one watch; what it does is seen from outside in watch_*_test.cpp.
#include "daemon/watched_tree.h"

#include <gtest/gtest.h>

#include <boost/asio/post.hpp>
#include <memory>
#include <thread>

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

}  // namespace
}  // namespace weir::watched_tree_test
