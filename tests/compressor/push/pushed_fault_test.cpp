// A push in which each call to the file system fails in turn. The next call of the push and all later ones report the
// error, and nothing is left on the disk.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "compressor/push/pushed_volume.h"
#include "format/base/error.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/memory_volume.h"
#include "tests/support/faulty_file_system.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_directory.h"

namespace weir::pushed_fault_test {
namespace {

using test::MemoryVolume;

constexpr Index3 kExtent{40, 33, 21};
// Whole layers come out of order, so that their slices become complete in exactly one order.
constexpr std::int64_t kPlanes[] = {8, 9, 10, 11, 12, 13, 14, 15, 20, 19, 18, 17, 16, 0, 1, 2, 3, 4, 5, 6, 7};

class PushedFaultTest : public testing::Test {
 protected:
  std::set<std::string> listing() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(directory_.path()))
      names.insert(entry.path().filename());
    return names;
  }

  // With one worker, and nobody waiting for it before the end, the calls come in one order.
  std::unique_ptr<PushedVolume> begin(FileSystem& files) const {
    ConversionOptions options;
    options.output = directory_ / "out.nvdb";
    options.threads = 1;
    return std::make_unique<PushedVolume>(volume_.info(), options, ConversionControl{}, files);
  }

  void push_all(PushedVolume& pushed) const {
    for (const std::int64_t z : kPlanes) pushed.slab(z, 1, &volume_.values()[static_cast<std::size_t>(z * 40 * 33)]);
  }

  template <typename Call>
  static std::string message_of(const Call& call) {
    try {
      call();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io) << error.what();
      return error.what();
    }
    return "";
  }

  TemporaryDirectory directory_;
  std::unique_ptr<FileSystem> real_ = make_posix_file_system();
  MemoryVolume volume_{*open_synthetic("cloud", {kExtent, 1})};
};

TEST_F(PushedFaultTest, EveryCallFailsInTurnAndNothingIsLeft) {
  FaultyFileSystem none(*real_, -1, 0);
  {
    const auto pushed = begin(none);
    push_all(*pushed);
    pushed->end();
  }
  const std::vector<std::string> calls = none.calls();
  ASSERT_GT(calls.size(), 30U);
  const std::set<std::string> result{"out.nvdb", "out.nvdb.json"};
  EXPECT_EQ(listing(), result);
  for (const int reason : {ENOSPC, EIO}) {
    for (int call = 0; call < static_cast<int>(calls.size()); ++call) {
      for (const std::string& name : result) std::filesystem::remove(directory_ / name);
      FaultyFileSystem files(*real_, call, reason);
      std::unique_ptr<PushedVolume> pushed;
      const std::string message = message_of([&] {
        pushed = begin(files);
        push_all(*pushed);
        pushed->end();
      });
      const std::string& name = calls[static_cast<std::size_t>(call)];
      SCOPED_TRACE("call " + std::to_string(call) + " " + name + ": " + message);
      EXPECT_TRUE(files.failed());
      if (name == "remove_directory") {
        // The empty hidden work directory stays, but the push itself is done.
        EXPECT_EQ(message, "");
        EXPECT_EQ(listing(), (std::set<std::string>{".out.nvdb.work", "out.nvdb", "out.nvdb.json"}));
        std::filesystem::remove(directory_ / ".out.nvdb.work");
        continue;
      }
      EXPECT_NE(message.find("call " + std::to_string(call) + " "), std::string::npos);
      EXPECT_EQ(listing(), name == "sync_directory" ? result : std::set<std::string>{});
      if (pushed == nullptr) continue;
      EXPECT_EQ(message_of([&] { pushed->slab(0, 1, volume_.values().data()); }), message);
      EXPECT_EQ(message_of([&] { pushed->end(); }), message);
    }
  }
}

// A killed simulation leaves two empty files. The next output of the same name takes them over.
TEST_F(PushedFaultTest, AKilledProcessLeavesNoValues) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer wants its own end";
  std::fflush(nullptr);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const auto pushed = begin(*real_);
    pushed->slab(0, 16, volume_.values().data());
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(listing(), (std::set<std::string>{".out.nvdb.work", "out.nvdb.partial"}));
  EXPECT_TRUE(std::filesystem::is_empty(directory_ / ".out.nvdb.work"));
  EXPECT_EQ(std::filesystem::file_size(directory_ / "out.nvdb.partial"), 0U);
  const auto pushed = begin(*real_);
  push_all(*pushed);
  pushed->end();
  EXPECT_EQ(listing(), (std::set<std::string>{"out.nvdb", "out.nvdb.json"}));
}

// Threads park, write and wait at the same time. Whatever fails, all threads return with the error.
TEST_F(PushedFaultTest, NoThreadHangsOnAFullDisk) {
  const Index3 extent{256, 256, 64};
  std::vector<float> plane(static_cast<std::size_t>(extent.x * extent.y));
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = static_cast<float>(i % 977);
  SourceInfo info;
  info.path = "density";
  info.extent = extent;
  ConversionOptions options;
  options.output = directory_ / "out.nvdb";
  options.threads = 1;
  options.memory = 1;
  const std::string least = [&] {
    try {
      PushedVolume(info, options, {}, *real_);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  }();
  options.memory = (std::stoull(least.substr(least.rfind(' ') + 1)) + 1) << 20U;
  for (const int call : {20, 21, 30, 40, 55, 80, 130, 200, 300, 500}) {
    FaultyFileSystem files(*real_, call, ENOSPC);
    {
      PushedVolume pushed(info, options, {}, files);
      std::atomic<std::int64_t> next{0};
      std::set<std::string> messages;
      std::mutex mutex;
      {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 4; ++t) {
          threads.emplace_back([&] {
            for (std::int64_t i = next++; i < extent.z; i = next++) {
              const std::string message = message_of([&] { pushed.slab(i * 37 % extent.z, 1, plane.data()); });
              if (message.empty()) continue;
              const std::lock_guard lock(mutex);
              messages.insert(message);
            }
          });
        }
      }
      const std::string last = message_of([&] { pushed.end(); });
      if (!files.failed()) {
        EXPECT_EQ(last, "");
        std::filesystem::remove(options.output);
        std::filesystem::remove(sidecar_path(options.output));
        continue;
      }
      EXPECT_NE(last.find("No space left on device"), std::string::npos) << last;
      for (const std::string& message : messages) EXPECT_EQ(message, last);
      EXPECT_EQ(listing(), std::set<std::string>{});
    }
  }
}

}  // namespace
}  // namespace weir::pushed_fault_test
