// Test fixture: two watches, a and b, and a JobRunner that runs their jobs with the real `weir`.
#pragma once

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "daemon/jobs/job_runner.h"
#include "daemon/store/file_identity.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir {

class RunningJobs : public testing::Test {
 protected:
  RunningJobs() {
    config_.service.log_file = directory_ / "log";
    config_.service.threads = 1;
    for (const char* label : {"a", "b"}) {
      WatchConfig watch;
      watch.label = label;
      watch.directory = directory_ / label;
      watch.output = directory_ / "out";
      watch.thumbnails = false;
      std::filesystem::create_directory(watch.directory);
      config_.watches.push_back(watch);
    }
    runner_.configure(config_);
  }

  /// Writes a complete source and adds its waiting job.
  Job add(const std::string& label, const std::string& name, std::size_t bytes = 24 * 20 * 16) {
    const std::string source = directory_ / (label + "/" + name + "_24x20x16_uint8.raw");
    write_file(source, std::string(bytes, 'x'));
    const Job job = store_.observe(label, source, *identify(source), "options").job;
    EXPECT_TRUE(store_.enqueue(job.id));
    return job;
  }
  /// Adds a job that takes some time: a gibibyte of zeros.
  Job add_long() {
    const std::string source = directory_ / "a/long_1024x1024x1024_uint8.raw";
    write_file(source, "");
    std::filesystem::resize_file(source, std::uintmax_t{1} << 30U);
    const Job job = store_.observe("a", source, *identify(source), "options").job;
    EXPECT_TRUE(store_.enqueue(job.id));
    return job;
  }
  void run_until(const std::function<bool()>& over) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!over() && std::chrono::steady_clock::now() < deadline) io_.run_one_for(std::chrono::milliseconds(50));
    EXPECT_TRUE(over());
  }
  /// Writes a `weir` that runs these lines of shell; $fd is the descriptor for its announcements.
  std::string write_program(const std::string& lines) const {
    const std::string program = directory_ / "weir";
    write_file(program, "#!/bin/sh\nfor a; do case $a in --progress-fd=*) fd=${a#*=};; esac; done\n" + lines);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    return program;
  }
  JobState state(const Job& job) const { return store_.job(job.id)->state; }
  bool idle() const { return runner_.running().empty(); }

  TemporaryDirectory directory_;
  DaemonConfig config_ = [this] {
    DaemonConfig config;
    config.service.log_file = directory_ / "log";
    return config;
  }();
  boost::asio::io_context io_;
  JobStore store_{directory_ / "weir.db"};
  EventLog log_{config_.service};
  std::vector<std::string> changed_;
  JobRunner runner_{io_, store_, log_, WEIR_COMMAND, [this](const Job& job) { changed_.push_back(job.source); }};
};

}  // namespace weir
