// Test fixture for SourceDeletion: a watch that deletes its sources, with one converted source.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "daemon/jobs/conversion_task.h"
#include "daemon/jobs/source_deletion.h"
#include "daemon/store/file_identity.h"
#include "format/sidecar/sidecar.h"
#include "tests/support/file_tick.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir {

class DeletingWatch : public testing::Test {
 protected:
  DeletingWatch() {
    std::filesystem::create_directory(directory_ / "in");
    std::filesystem::create_directory(directory_ / "out");
    WatchConfig watch;
    watch.label = "w";
    watch.directory = directory_ / "in";
    watch.output = directory_ / "out";
    watch.source = AfterDone::delete_after_verify;
    watch.delete_after_s = 0.05;
    config_.watches = {watch};
    write_file(source_, "values");
    pass_file_tick();
    write_output("");
  }

  /// Writes the output and certificate of a raw file; `more` is appended to the keys of its source.
  void write_output(const std::string& more) const {
    write_file(output_, "volume");
    write_file(sidecar_path(output_), R"({"source": {"path": ")" + source_ + R"(", "bytes": 6, "mtime": ")" +
                                          utc_text(identify(source_)->mtime_ns) +
                                          R"(", "format": "raw", "type": "uint8", "extent": [1, 2, 3])" + more + "}}");
  }
  /// Converts the source: creates its done job with one output of maximum `max`. Returns the job's ID.
  std::int64_t convert(std::optional<double> max = std::nullopt) {
    const std::int64_t id = store_.observe("w", source_, *identify(source_), options_text(config_.watches[0])).job.id;
    store_.enqueue(id);
    store_.start(id);
    JobResult result;
    JobOutput output;
    output.path = output_;
    output.bytes = 6;
    output.max = max;
    result.outputs = {output};
    store_.finish(id, result);
    return id;
  }
  void delete_done() {
    deletion_.configure(config_);
    deletion_.done(convert());
  }
  bool run_until(const std::function<bool()>& holds, std::chrono::milliseconds patience = std::chrono::seconds(20)) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!holds()) {
      if (std::chrono::steady_clock::now() > end) return false;
      io_.restart();
      io_.run_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  bool stays() {
    EXPECT_TRUE(run_until([&] { return deletion_.idle(); }));
    return std::filesystem::exists(source_);
  }
  std::string hidden(std::int64_t id) const { return directory_ / "in/.weir-delete-" + std::to_string(id); }
  bool logged(const std::string& text) const { return read_file(directory_ / "log").find(text) != std::string::npos; }

  TemporaryDirectory directory_;
  std::string source_ = directory_ / "in/a_1x2x3_uint8.raw";
  std::string output_ = directory_ / "out/a.nvdb";
  DaemonConfig config_;
  boost::asio::io_context io_;
  JobStore store_{directory_ / "weir.db"};
  ServiceConfig service_ = [this] {
    ServiceConfig service;
    service.log_file = directory_ / "log";
    return service;
  }();
  EventLog log_{service_};
  bool held_ = false;
  SourceDeletion deletion_{io_, store_, log_, [this] { return held_; }};
};

}  // namespace weir
