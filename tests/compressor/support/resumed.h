// Conversions in memory that are interrupted or killed and run again.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "compressor/conversion_memory.h"
#include "compressor/plan/memory_plan.h"
#include "format/base/error.h"
#include "format/process/process_memory.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/memory_volume.h"
#include "tests/support/faulty_file_system.h"
#include "tests/support/sanitized.h"

namespace weir::test {

using Bytes = CrashFileSystem::Bytes;
using Names = std::vector<std::string>;

inline const Names kResult{"out.nvdb", "out.nvdb.json"};
inline const std::string kHidden = "./.out.nvdb.work/";

// A domain of ten blocks of 1 MiB in five regions. Its faces do not lie on node borders.
inline constexpr Box kDomain{{-60, 3, 5}, {4, 64, 645}};

inline float ripples(const Index3& i) {
  const auto [x, y, z] = std::array{static_cast<double>(i.x), static_cast<double>(i.y), static_cast<double>(i.z)};
  return static_cast<float>(90 * std::sin(x / 9) * std::cos(y / 7 + z / 50) + 3 * std::sin(x * y) + z / 40);
}

// Returns the least memory ceiling to the byte. Rounded to a MiB, as in the error's advice, chance would decide whether
// a block has one layer of leaves or two, and so how many calls are made.
inline std::uint64_t least_memory(MemoryVolume& volume, std::size_t threads) {
  const std::uint64_t resident = resident_bytes() + volume.working_bytes();
  return least_ceiling(resident, threads, volume.info().domain(), region_bytes({}));
}

// The memory by which the process may grow between least_memory() and the conversion. With a sanitizer the margin lets
// the whole volume be one block.
inline constexpr std::uint64_t kMargin = std::uint64_t{kSanitized ? 160 : 2} << 20U;

// Returns the sidecar's text without the seconds and bytes that depend on the machine and the run.
inline std::string record_of(Sidecar sidecar) {
  sidecar.timing = {};
  return to_json_text(sidecar);
}

struct Result {
  Bytes file;
  std::string record;
  std::uint64_t bytes_read = 0;
  Names notices;
  int encode_passes = 0;
};

class ResumeTest : public ::testing::Test {
 protected:
  explicit ResumeTest(float (*value)(const Index3&) = ripples, const Box& domain = kDomain) : volume_(domain, value) {}

  ConversionOptions base() const {
    ConversionOptions options;
    options.output = "out.nvdb";
    options.budget.kind = Budget::Kind::rate;
    options.resume = Resume::on;
    options.save_interval_s = 0;
    options.memory = 0;  // bytes above the least memory
    options.threads = 1;
    return options;
  }

  Result run(ConversionOptions options, FileSystem& files) {
    options.memory += least_memory(volume_, options.threads) + kMargin;
    Result result;
    ConversionControl control;
    control.notice = [&](const Message& line) { result.notices.push_back(line.text()); };
    control.pass_started = [&](const std::string& pass, std::uint64_t) { result.encode_passes += pass == "encode"; };
    const std::uint64_t before = volume_.bytes_read();
    result.record = record_of(convert_volume(volume_, options, control, files));
    result.bytes_read = volume_.bytes_read() - before;
    return result;
  }

  Result undisturbed(ConversionOptions options) {
    CrashFileSystem files;
    options.resume = Resume::off;
    Result result = run(options, files);
    EXPECT_EQ(files.names(), kResult);
    result.file = files.take("out.nvdb");
    return result;
  }

  // Returns the number of calls to the file system.
  int calls_of(const ConversionOptions& options) {
    CrashFileSystem memory;
    FaultyFileSystem files(memory, -1, 0);
    run(options, files);
    EXPECT_EQ(memory.names(), kResult) << "a conversion that ends leaves nothing";
    return static_cast<int>(files.calls().size());
  }

  // Runs a conversion that dies at call `at`, as a killed process does. Returns false if it ends before that call.
  bool killed(const ConversionOptions& options, CrashFileSystem& memory, int at) {
    FaultyFileSystem files(memory, at, EIO, FaultyFileSystem::After::fails);
    try {
      run(options, files);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io) << error.what();
      return true;
    }
    return files.failed();
  }

  // Kills the conversion at about `points` calls, spread over the conversion, and continues it with other options.
  void expect_same_bytes(const ConversionOptions& options, int points) {
    const Result expected = undisturbed(options);
    const int calls = calls_of(options);
    ConversionOptions otherwise = options;
    otherwise.memory = options.memory + (std::uint64_t{12} << 20U);
    otherwise.threads = 3;
    int continued = 0;
    for (int i = 0; i < points; ++i) {
      const int at = static_cast<int>(static_cast<std::int64_t>(calls) * i / points);
      SCOPED_TRACE("killed at call " + std::to_string(at) + " of " + std::to_string(calls));
      CrashFileSystem memory;
      if (!killed(options, memory, at)) {
        if (!kSanitized) ADD_FAILURE() << "it ended before";
        continue;
      }
      if (i % 2 == 0) memory.lose_unflushed();
      // Every third conversion is killed a second time. If it was killed after the last rename, the user must pass
      // --overwrite.
      otherwise.overwrite = !memory.content("out.nvdb").empty();
      if (i % 3 == 0 && killed(otherwise, memory, calls / 5)) memory.lose_unflushed();
      ConversionOptions again = i % 4 == 0 ? options : otherwise;
      again.overwrite = !memory.content("out.nvdb").empty();
      const Result result = run(again, memory);
      EXPECT_EQ(memory.names(), kResult);
      EXPECT_TRUE(memory.content("out.nvdb") == expected.file);
      EXPECT_EQ(result.record, expected.record);
      if (result.bytes_read < expected.bytes_read) ++continued;
    }
    if (!kSanitized) {
      EXPECT_GT(continued, points / 5) << "so many had something to go on from";
    }
  }

  // Interrupts the conversion when `bytes` of the pass `name` are done. Returns the error message.
  std::string interrupted(ConversionOptions options, FileSystem& files, const std::string& name, std::uint64_t bytes) {
    options.save_interval_s = 3600;  // only the interruption saves
    options.memory += least_memory(volume_, options.threads) + kMargin;
    std::atomic<bool> cancel{false};
    std::string pass;
    ConversionControl control;
    control.cancel = &cancel;
    control.pass_started = [&](const std::string& started, std::uint64_t) { pass = started; };
    control.pass_advanced = [&](std::uint64_t done) { cancel = cancel || (pass == name && done >= bytes); };
    try {
      convert_volume(volume_, options, control, files);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::interrupted);
      return error.what();
    }
    ADD_FAILURE() << "was not interrupted";
    return {};
  }

  MemoryVolume volume_;
};

class ResumeOfHoles : public ResumeTest {
 protected:
  ResumeOfHoles() : ResumeTest([](const Index3& i) { return i.z % 97 == 5 ? NAN : ripples(i); }) {}
};

}  // namespace weir::test
