// Calls of a push in memory, and the answers of these calls.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "compressor/push/pushed_volume.h"
#include "format/base/error.h"
#include "tests/compressor/support/crash_file_system.h"

namespace weir::test {

class PushCalls : public testing::Test {
 protected:
  static constexpr Index3 kExtent{9, 5, 20};

  PushCalls() {
    info_.path = "density";
    info_.extent = kExtent;
    options_.output = "out.nvdb";
  }

  /// Returns the message of the Error of `kind` that `call` throws; "no error" if it throws none.
  static std::string message(ErrorKind kind, const std::function<void()>& call) {
    try {
      call();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      return error.what();
    }
    return "no error";
  }

  CrashFileSystem files_;
  SourceInfo info_;
  ConversionOptions options_;
  std::vector<float> values_ = std::vector<float>(static_cast<std::size_t>(volume(kExtent)), 1.5F);
};

}  // namespace weir::test
