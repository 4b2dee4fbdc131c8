#include "tools/view/histogram_counts.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace weir::histogram_counts_test {
namespace {

using Texts = std::map<ViewerId, std::vector<std::string>>;
using std::chrono::milliseconds;

/// Counts that last until the test lets them go or they are cancelled.
class HistogramCountsTest : public testing::Test {
 protected:
  std::string count(const HistogramQuestion& question, const std::atomic<bool>& cancel) {
    {
      const std::lock_guard lock(mutex_);
      begun_.push_back(question.path);
    }
    while (!go_ && !cancel) std::this_thread::sleep_for(milliseconds(1));
    if (cancel) throw std::runtime_error("interrupted");
    if (question.path == "bad") throw std::runtime_error("bad: is no file");
    return "counted " + question.path;
  }
  std::vector<std::string> begun() {
    const std::lock_guard lock(mutex_);
    return begun_;
  }
  bool eventually(const std::function<bool()>& holds) {
    for (int i = 0; i < 4000 && !holds(); ++i) {
      io_.restart();
      if (io_.run_for(milliseconds(2)) == 0) std::this_thread::sleep_for(milliseconds(1));
    }
    return holds();
  }

  std::atomic<bool> go_{false};
  std::mutex mutex_;
  std::vector<std::string> begun_;
  Texts told_;
  boost::asio::io_context io_;
  HistogramCounts counts_{
      io_,
      [this](const HistogramQuestion& question, const std::atomic<bool>& cancel) { return count(question, cancel); },
      [this](ViewerId id, const std::string& text) { told_[id].push_back(text); }};
};

TEST_F(HistogramCountsTest, EachFile_IsCountedOnceForAll) {
  for (const ViewerId viewer : {1, 2, 3}) counts_.ask(viewer, {0, 0, "a"});
  counts_.ask(1, {0, 1, "b"});
  go_ = true;
  ASSERT_TRUE(eventually([&] { return told_[1].size() == 2; }));
  EXPECT_EQ(told_, (Texts{{1, {"counted a", "counted b"}}, {2, {"counted a"}}, {3, {"counted a"}}}));
  counts_.ask(4, {0, 0, "a"});
  ASSERT_TRUE(eventually([&] { return told_[4].size() == 1; }));
  EXPECT_EQ(begun(), (std::vector<std::string>{"a", "b"}));
}

TEST_F(HistogramCountsTest, WhatNobodyWaitsFor_IsGivenUp) {
  counts_.ask(1, {0, 0, "a"});
  ASSERT_TRUE(eventually([&] { return begun().size() == 1; }));
  counts_.ask(1, {1, 0, "b"});  // scrubbed on, twice
  counts_.ask(1, {2, 0, "c"});
  counts_.ask(2, {3, 0, "d"});
  counts_.forget(2);
  ASSERT_TRUE(eventually([&] { return begun().size() == 2; }));
  go_ = true;
  ASSERT_TRUE(eventually([&] { return told_[1].size() == 1; }));
  EXPECT_EQ(told_, (Texts{{1, {"counted c"}}}));
  EXPECT_EQ(begun(), (std::vector<std::string>{"a", "c"}));
}

TEST_F(HistogramCountsTest, WhoComesToOneThatIsGivenUp_HasItCountedAgain) {
  counts_.ask(1, {0, 0, "a"});
  ASSERT_TRUE(eventually([&] { return begun().size() == 1; }));
  counts_.forget(1);
  counts_.ask(2, {0, 0, "a"});
  ASSERT_TRUE(eventually([&] { return begun().size() == 2; }));
  go_ = true;
  ASSERT_TRUE(eventually([&] { return told_[2].size() == 1; }));
  EXPECT_EQ(told_, (Texts{{2, {"counted a"}}}));
}

TEST_F(HistogramCountsTest, AskedAgainByTheSameViewer_IsNotBegunAgain) {
  counts_.ask(1, {0, 0, "a"});
  ASSERT_TRUE(eventually([&] { return begun().size() == 1; }));
  counts_.ask(1, {0, 0, "a"});
  go_ = true;
  ASSERT_TRUE(eventually([&] { return told_[1].size() == 1; }));
  EXPECT_EQ(begun(), (std::vector<std::string>{"a"}));
}

TEST_F(HistogramCountsTest, Failure_IsSaid) {
  go_ = true;
  counts_.ask(1, {0, 0, "bad"});
  counts_.ask(2, {0, 0, "a"});
  ASSERT_TRUE(eventually([&] { return told_[1].size() + told_[2].size() == 2; }));
  EXPECT_EQ(told_[1].front(), "{\"type\":\"error\",\"view\":0,\"message\":\"bad: is no file\"}");
}

}  // namespace
}  // namespace weir::histogram_counts_test
