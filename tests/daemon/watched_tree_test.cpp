// Tests the life of one watch; watch_*_test.cpp tests its results from outside.
#include "daemon/watched_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "format/base/text.h"
#include "tests/support/temporary_directory.h"

namespace weir::watched_tree_test {
namespace {

// A reload removes a watch whose timer has fired but whose turn comes after the reload.
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

TEST(WatchedTree, AKeyWithoutEffect_IsLogged) {
  const TemporaryDirectory directory;
  boost::asio::io_context io;
  JobStore store(directory / "weir.db");
  ServiceConfig service;
  service.log_file = directory / "weir.log";
  const EventLog log(service);
  DiskTurns turns(io);
  WatchConfig watch;
  watch.label = watch.directory = directory / "in";
  watch.output = directory / "out";
  const auto logged = [&](bool gives_delete_after) {
    watch.gives_delete_after = gives_delete_after;
    const WatchedTree tree(io, turns, watch, store, log, WatchedTree::Reports{[] {}, [](std::int64_t) {}});
    std::ifstream in(service.log_file);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(logged(false).find("delete_after"), std::string::npos);
  EXPECT_NE(
      logged(true).find("warning watch watch=" + watch.label + " notice=\"delete_after has no effect, since nothing "),
      std::string::npos);
}

/// A tree over a directory of its own, without a service.
class WatchedTreeTest : public ::testing::Test {
 protected:
  WatchConfig watch() const {
    WatchConfig watch;
    watch.label = watch.directory = directory_ / "in";
    watch.output = directory_ / "out";
    return watch;
  }
  std::int64_t observe(const std::string& name) {
    return store_.observe(watch().label, watch().directory + '/' + name, {8, 1, 1}, "").job.id;
  }
  WatchedTree tree() {
    return {io_, turns_, watch(), store_, log_, WatchedTree::Reports{[] {}, [](std::int64_t) {}}};
  }
  /// Runs handlers until `holds` returns true, for at most ten seconds. Returns whether it did.
  template <typename Condition>
  bool run_until(Condition holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!holds() && std::chrono::steady_clock::now() < end) io_.run_one_for(std::chrono::milliseconds(5));
    return holds();
  }

  TemporaryDirectory directory_;
  boost::asio::io_context io_;
  JobStore store_{directory_ / "weir.db"};
  EventLog log_{ServiceConfig{}};
  DiskTurns turns_{io_};
};

TEST_F(WatchedTreeTest, JobsOfFilesThatAreGone_AreForgotten) {
  std::filesystem::create_directory(watch().directory);
  std::vector<std::int64_t> gone;
  for (int i = 0; i < 300; ++i) gone.push_back(observe(cat("gone", i, "_2x2x2_uint8.raw")));
  const std::int64_t done = observe("done_2x2x2_uint8.raw");
  store_.enqueue(done);
  store_.start(done);
  store_.finish(done, {});
  const WatchedTree tree = this->tree();
  EXPECT_TRUE(run_until([&] { return !store_.job(gone.front()) && !store_.job(gone.back()); }));
  EXPECT_TRUE(store_.job(done)) << "the record of its result";
}

// A cancelled job is kept when its source goes away; a waiting job is removed then.
TEST_F(WatchedTreeTest, ACancelledJob_IsKeptWhenItsSourceGoes) {
  std::filesystem::create_directory(watch().directory);
  const auto path = [&](const char* name) { return watch().directory + '/' + name; };
  for (const char* name : {"a_2x2x2_uint8.raw", "b_2x2x2_uint8.raw"}) std::ofstream(path(name)) << "12345678";
  const WatchedTree tree = this->tree();
  const auto job = [&](const char* name) { return store_.find(watch().label, path(name)); };
  ASSERT_TRUE(run_until([&] { return job("a_2x2x2_uint8.raw") && job("b_2x2x2_uint8.raw"); }));
  ASSERT_TRUE(store_.cancel(job("a_2x2x2_uint8.raw")->id));
  std::filesystem::remove(path("a_2x2x2_uint8.raw"));
  std::filesystem::remove(path("b_2x2x2_uint8.raw"));
  ASSERT_TRUE(run_until([&] { return !job("b_2x2x2_uint8.raw"); }));
  ASSERT_TRUE(job("a_2x2x2_uint8.raw"));
  EXPECT_EQ(job("a_2x2x2_uint8.raw")->state, JobState::cancelled);
}

TEST_F(WatchedTreeTest, JobsOfADirectoryThatIsNotMountedYet_AreKept) {
  const std::int64_t id = observe("a_2x2x2_uint8.raw");
  const WatchedTree tree = this->tree();
  run_until([&] { return tree.status().reason.find("is not there") != std::string::npos; });
  for (int i = 0; i < 20; ++i) io_.run_one_for(std::chrono::milliseconds(5));
  EXPECT_TRUE(store_.job(id));
}

TEST_F(WatchedTreeTest, JobsOfADirectoryThatGoesAwayAndComesBack_AreKept) {
  std::filesystem::create_directory(watch().directory);
  const std::string path = watch().directory + "/a_2x2x2_uint8.raw";
  std::ofstream(path) << "12345678";
  int woken = 0;
  const WatchedTree tree{io_,    turns_, watch(),
                         store_, log_,   WatchedTree::Reports{[&woken] { ++woken; }, [](std::int64_t) {}}};
  ASSERT_TRUE(run_until([&] { return store_.find(watch().label, path).has_value(); }));
  const std::int64_t id = store_.find(watch().label, path)->id;
  std::filesystem::rename(watch().directory, directory_ / "away");
  ASSERT_TRUE(run_until([&] { return !tree.status().up; }));
  for (int i = 0; i < 200; ++i) io_.run_one_for(std::chrono::milliseconds(5));
  ASSERT_TRUE(store_.job(id)) << "it was forgotten";
  const int woken_before = woken;
  std::filesystem::rename(directory_ / "away", watch().directory);
  EXPECT_TRUE(run_until([&] { return woken > woken_before && store_.job(id)->state == JobState::waiting; }));
}

// The job may have been forgotten by an earlier version of the service or by a user.
TEST_F(WatchedTreeTest, FilesOfADirectoryThatComesBack_AreFoundWithoutTheirJobs) {
  std::filesystem::create_directory(watch().directory);
  const std::string path = watch().directory + "/a_2x2x2_uint8.raw";
  std::ofstream(path) << "12345678";
  const WatchedTree tree = this->tree();
  ASSERT_TRUE(run_until([&] {
    const auto job = store_.find(watch().label, path);
    return job && job->state == JobState::waiting;
  }));
  std::filesystem::rename(watch().directory, directory_ / "away");
  ASSERT_TRUE(run_until([&] { return !tree.status().up; }));
  store_.remove(store_.find(watch().label, path)->id);
  std::filesystem::rename(directory_ / "away", watch().directory);
  EXPECT_TRUE(run_until([&] { return store_.find(watch().label, path).has_value(); }));
}

TEST_F(WatchedTreeTest, LogLevelDebug_TellsOfEachLook) {
  std::filesystem::create_directory(watch().directory);
  std::ofstream(watch().directory + "/a_2x2x2_uint8.raw") << "12345678";
  ServiceConfig service;
  service.log_file = directory_ / "log";
  service.log_level = "debug";
  log_.reopen(service);
  const WatchedTree tree = this->tree();
  EXPECT_TRUE(
      run_until([&] { return store_.find(watch().label, watch().directory + "/a_2x2x2_uint8.raw").has_value(); }));
  std::ifstream in(service.log_file);
  const std::string log(std::istreambuf_iterator<char>(in), {});
  EXPECT_NE(log.find(cat(" debug look watch=", watch().label, " events=1 looked_at=1 waiting=1 directories=")),
            std::string::npos)
      << log;
}

// Each record causes a flush of the disk that the simulation writes to.
TEST_F(WatchedTreeTest, FileThatIsWrittenTo_IsRecordedNowAndThen) {
  std::filesystem::create_directory(watch().directory);
  const WatchedTree tree = this->tree();
  const std::string path = watch().directory + "/a_64x64x64_uint8.raw";
  std::ofstream file(path, std::ios::binary);
  std::set<std::uint64_t> sizes;
  const auto recorded = [&] {
    if (const auto job = store_.find(watch().label, path)) sizes.insert(job->identity.bytes);
  };
  for (int i = 0; i < 60; ++i) {
    file << std::string(4096, 'a') << std::flush;
    for (int n = 0; n < 8; ++n) io_.run_one_for(std::chrono::milliseconds(3));
    recorded();
  }
  EXPECT_GE(sizes.size(), 1U);
  EXPECT_LE(sizes.size(), 3U) << "of 60 that it had";
  file << std::string((64U << 12U) - 60 * 4096, 'a');
  file.close();
  EXPECT_TRUE(run_until([&] { return store_.find(watch().label, path)->state == JobState::waiting; }));
  recorded();
  EXPECT_EQ(*sizes.rbegin(), 64U << 12U) << "as it is when it is complete";
}

std::size_t open_descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

TEST(WatchedTree, ManyLargeHierarchies_AreLookedThroughWithFewOpenDirectories) {
  constexpr int kStores = 24;
  constexpr int kFiles = 1100;  // more than one turn looks at
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
  EXPECT_LE(most, before + 6);  // the watch, a listing and two looks
}

}  // namespace
}  // namespace weir::watched_tree_test
