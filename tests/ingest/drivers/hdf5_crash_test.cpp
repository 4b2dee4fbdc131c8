// Signals of a crash within the HDF5 library and elsewhere, each in a process of its own.
#include "ingest/drivers/hdf5_crash.h"

#include <gtest/gtest.h>

#include <csignal>

#include "tests/support/sanitized.h"

namespace weir::hdf5_crash_test {
namespace {

class Hdf5Crash : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "the sanitizer handles these signals";
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // other tests have started threads
  }
};

TEST_P(Hdf5Crash, WithinTheLibrary_EndsWithALineAndExitCode3) {
  EXPECT_EXIT(
      {
        report_hdf5_crashes();
        const Hdf5Call call("/data/a\nb.h5");
        ::raise(GetParam());
      },
      ::testing::ExitedWithCode(3),
      "^weir: /data/a\\?b\\.h5: the HDF5 library crashed at it; the file is damaged, or the library has a fault: copy "
      "the "
      "file again, or write it anew\n$");
}

TEST_P(Hdf5Crash, Elsewhere_EndsByTheSignal) {
  EXPECT_EXIT(
      {
        report_hdf5_crashes();
        { const Hdf5Call ended("/data/a.h5"); }
        ::raise(GetParam());
      },
      ::testing::KilledBySignal(GetParam()), "^$");
}

INSTANTIATE_TEST_SUITE_P(Signals, Hdf5Crash, ::testing::Values(SIGSEGV, SIGBUS, SIGABRT));

}  // namespace
}  // namespace weir::hdf5_crash_test
