// Test fixture: a state file with a clock that the test sets, and functions that add jobs in several states.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/store/job_store.h"
#include "tests/support/temporary_directory.h"

namespace weir::test {

inline constexpr FileIdentity kIdentity{1000, 1'700'000'000'123'456'789, 77};
class StoredJobs : public testing::Test {
 protected:
  StoredJobs() { open(); }

  void open() {
    store_.reset();
    store_ = std::make_unique<JobStore>(directory_ / "weir.db", [this] { return now_; });
  }
  std::int64_t observe(const std::string& source, const FileIdentity& identity = kIdentity,
                       const std::string& watch = "w") {
    return store_->observe(watch, source, identity, "--rate=8").job.id;
  }
  std::int64_t waiting(const std::string& source, const FileIdentity& identity = kIdentity,
                       const std::string& watch = "w") {
    const std::int64_t id = observe(source, identity, watch);
    EXPECT_TRUE(store_->enqueue(id));
    return id;
  }
  std::int64_t running(const std::string& source, const std::string& watch = "w") {
    const std::int64_t id = waiting(source, kIdentity, watch);
    EXPECT_TRUE(store_->start(id));
    return id;
  }
  Job job(std::int64_t id) const { return store_->job(id).value(); }
  std::vector<std::string> candidates(Priority priority, std::size_t limit = 100) const {
    std::vector<std::string> sources;
    for (const Job& job : store_->candidates("w", priority, limit)) sources.push_back(job.source);
    return sources;
  }
  std::vector<std::string> sources(const JobFilter& filter, std::size_t offset = 0, std::size_t limit = 100) const {
    std::vector<std::string> sources;
    for (const Job& job : store_->jobs(filter, offset, limit)) sources.push_back(job.source);
    return sources;
  }
  using Names = std::vector<std::string>;

  TemporaryDirectory directory_;
  std::int64_t now_ = 1'800'000'000'000;
  std::unique_ptr<JobStore> store_;
};

inline JobResult failure(int exit_code, const std::string& reason = "it broke") {
  JobResult result;
  result.exit_code = exit_code;
  result.reason = reason;
  result.log_tail = "a line\nanother\n";
  return result;
}

inline JobResult success() {
  JobResult result;
  result.outputs = {{"/out/a_0.nvdb", 512, 8.0, 51.25, 0.5, -1.0, 3e30, "/out/a_0.nvdb.png"},
                    {"/out/a_1.nvdb", 1024, 4.0, {}, {}, {}, {}, ""}};
  result.seconds = 1.5;
  result.source_bytes = 4000;
  result.bytes_read = 8000;
  result.bytes_written = 1536;
  result.peak_rss_bytes = std::uint64_t{1} << 33;
  return result;
}

}  // namespace weir::test
