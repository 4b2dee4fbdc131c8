// Tests what a program reports if it crashes or never returns within the HDF5 library, and that crashes elsewhere are
// left alone. Each case runs in a process of its own.
#include "ingest/drivers/hdf5_crash.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/ingest/support/deep_stack.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_directory.h"

namespace weir::hdf5_crash_test {
namespace {

class Hdf5Crash : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "the sanitizer handles these signals";
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // because other tests have started threads
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

TEST(Hdf5StackUsedUp, WithinTheLibrary_EndsWithALineAndExitCode3) {
  if (kSanitized) GTEST_SKIP() << "the sanitizer handles these signals";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        report_hdf5_crashes();
        const Hdf5Call call("/data/a.h5");
        ::_exit(use_up_stack());
      },
      ::testing::ExitedWithCode(3), "^weir: /data/a\\.h5: the HDF5 library crashed at it; .*\n$");
}

// Computes until the process has taken `seconds` more of processor time.
void compute_for(double seconds) {
  const std::clock_t begun = std::clock();
  while (static_cast<double>(std::clock() - begun) < seconds * CLOCKS_PER_SEC) continue;
}

TEST(Hdf5Stall, OfSeveralShortCalls_IsNone) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        report_hdf5_crashes(std::chrono::milliseconds(300));
        for (int i = 0; i < 4; ++i) {
          {
            const Hdf5Call call("/data/a.h5");
            compute_for(0.1);
          }
          compute_for(0.15);
        }
        ::_exit(7);
      },
      ::testing::ExitedWithCode(7), "^$");
}

TEST(Hdf5Stall, WithinTheLibrary_EndsWithALineAndExitCode3) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        report_hdf5_crashes(std::chrono::milliseconds(1100));
        const Hdf5Call call("/data/a.h5");
        while (::getpid() != 0) continue;
      },
      ::testing::ExitedWithCode(3),
      "^weir: /data/a\\.h5: the HDF5 library came to no end at it in 1 s of computing; the file is damaged, or the "
      "library "
      "has a fault: copy the file again, or write it anew\n$");
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

TEST_P(Hdf5Crash, WithinTheLibrary_RemovesWhatWasBegun) {
  const TemporaryDirectory directory;
  const std::string work = directory / ".o.nvdb.work";
  const std::string kept = directory / "kept";
  for (const std::string& made : {work, kept}) std::filesystem::create_directory(made);
  for (const char* name : {"o.nvdb.partial", "kept/journal"}) std::ofstream(directory / name) << "begun";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    report_hdf5_crashes();
    const Hdf5CrashRemoval removal({work, kept, directory / "o.nvdb.partial"});
    const Hdf5Call call("/data/a.h5");
    ::raise(GetParam());
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 3) << status;
  EXPECT_FALSE(std::filesystem::exists(work));
  EXPECT_FALSE(std::filesystem::exists(directory / "o.nvdb.partial"));
  EXPECT_TRUE(std::filesystem::exists(directory / "kept/journal"));
}

INSTANTIATE_TEST_SUITE_P(Signals, Hdf5Crash, ::testing::Values(SIGSEGV, SIGBUS, SIGABRT));

}  // namespace
}  // namespace weir::hdf5_crash_test
