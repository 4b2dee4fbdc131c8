// Test fixture: runs one ConversionJob of the real `weir` to its end.
#pragma once

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/jobs/conversion_job.h"
#include "daemon/store/file_identity.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir {

class OneConversionJob : public testing::Test {
 protected:
  std::string write_source(const std::string& name, std::size_t voxels) const {
    std::string bytes(voxels, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7);
    write_file(directory_ / name, bytes);
    return directory_ / name;
  }

  ConversionTask task(const std::string& source) const {
    ConversionTask task;
    task.program = WEIR_COMMAND;
    task.source = source;
    task.identity = identify(source).value_or(FileIdentity{});
    task.output = directory_ / "out/";
    task.memory = std::uint64_t{256} << 20U;
    task.threads = 1;
    return task;
  }

  /// Returns the last report. The report before it, if any, is first_report_.
  TaskReport run(const ConversionTask& task, const std::function<void(ConversionJob&)>& meanwhile = {}) {
    boost::asio::io_context io;
    std::optional<TaskReport> report;
    first_report_.reset();
    std::unique_ptr<ConversionJob> job = std::make_unique<ConversionJob>(io, task, [&](const TaskReport& ended) {
      EXPECT_FALSE(report);
      if (ended.rendering) {
        EXPECT_FALSE(first_report_);
        first_report_ = ended;
        return;
      }
      report = ended;
      job.reset();
    });
    while (!report && io.run_one() > 0) {
      if (job && meanwhile) meanwhile(*job);
    }
    EXPECT_TRUE(report);
    return report.value_or(TaskReport{});
  }

  TemporaryDirectory directory_;
  std::optional<TaskReport> first_report_;
};

}  // namespace weir
