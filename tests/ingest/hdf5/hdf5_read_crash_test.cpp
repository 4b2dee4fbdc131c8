// Crashes of the HDF5 library while it reads values. A filter that raises a signal stands in for a damaged chunk. Each
// case runs in a process of its own.
#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "ingest/drivers/hdf5_crash.h"
#include "ingest/hdf5/file/hdf5_lock.h"
#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/support/deep_stack.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_directory.h"

namespace weir::hdf5_read_crash_test {
namespace {

constexpr H5Z_filter_t kFilter = 511;  // one of the numbers that HDF5 reserves for tests
constexpr hsize_t kEdge = 8;

size_t crash(unsigned flags, size_t /*count*/, const unsigned* /*values*/, size_t bytes, size_t* /*room*/,
             void** /*buffer*/) {
  if ((flags & H5Z_FLAG_REVERSE) != 0) ::raise(SIGSEGV);
  return bytes;
}

void write_file(const std::string& path) {
  const Hdf5Lock lock;
  const H5Z_class2_t filter{H5Z_CLASS_T_VERS, kFilter, 1, 1, "crash", nullptr, nullptr, crash};
  ASSERT_GE(H5Zregister(&filter), 0);
  const std::vector<hsize_t> extent(3, kEdge);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(3, extent.data(), nullptr);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(creation, 3, extent.data());
  H5Pset_filter(creation, kFilter, H5Z_FLAG_MANDATORY, 0, nullptr);
  const hid_t dataset = H5Dcreate2(file, "d", H5T_NATIVE_FLOAT, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  const std::vector<float> values(kEdge * kEdge * kEdge, 1);
  EXPECT_GE(H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Dclose(dataset);
  H5Pclose(creation);
  H5Sclose(space);
  H5Fclose(file);
}

class Hdf5ReadCrash : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "the sanitizer handles these signals";
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // because other tests have started threads
  }
};

TEST_F(Hdf5ReadCrash, OfAThread_EndsWithALineAndExitCode3) {
  EXPECT_EXIT(
      {
        const TemporaryDirectory directory;
        write_file(directory / "a.h5");
        const auto source = open_hdf5(directory / "a.h5", {});
        report_hdf5_crashes();
        watch_hdf5_reads(hdf5_reads());
        std::vector<float> values(kEdge * kEdge * kEdge);
        std::thread([&] { source->read(source->info().domain(), values); }).join();
      },
      ::testing::ExitedWithCode(3),
      "^weir: .*/a\\.h5: /d: the HDF5 library crashed at it; the file is damaged, or the library has a fault: copy the "
      "file again, or write it anew\n$");
}

TEST_F(Hdf5ReadCrash, ByAThreadsStackThatIsUsedUp_EndsWithALineAndExitCode3) {
  EXPECT_EXIT(
      {
        report_hdf5_crashes();
        watch_hdf5_reads(hdf5_reads());
        const std::string line = hdf5_crash_line("a.h5: /d");
        std::thread([&] {
          const Hdf5ReadLock lock(line);
          ::_exit(use_up_stack());
        }).join();
      },
      ::testing::ExitedWithCode(3), "^weir: a\\.h5: /d: the HDF5 library crashed at it; .*\n$");
}

TEST_F(Hdf5ReadCrash, OfAnotherThreadMeanwhile_EndsByTheSignal) {
  EXPECT_EXIT(
      {
        report_hdf5_crashes();
        watch_hdf5_reads(hdf5_reads());
        const std::string line = hdf5_crash_line("a.h5: /d");
        const Hdf5ReadLock lock(line);
        std::thread([] { ::raise(SIGSEGV); }).join();
      },
      ::testing::KilledBySignal(SIGSEGV), "^$");
}

TEST_F(Hdf5ReadCrash, AfterTheRead_EndsByTheSignal) {
  EXPECT_EXIT(
      {
        report_hdf5_crashes();
        watch_hdf5_reads(hdf5_reads());
        const std::string line = hdf5_crash_line("a.h5: /d");
        { const Hdf5ReadLock lock(line); }
        ::raise(SIGSEGV);
      },
      ::testing::KilledBySignal(SIGSEGV), "^$");
}

}  // namespace
}  // namespace weir::hdf5_read_crash_test
