// Reads files with changed bytes, each in a process of its own. The process ends with the values that the library
// reads, with an error of one line, or with the line of a crash or a stall within the library.
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <new>
#include <random>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "ingest/drivers/hdf5_crash.h"
#include "ingest/hdf5/file/hdf5_lock.h"
#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/chunked_file.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_directory.h"

namespace weir::hdf5_mutation_test {
namespace {

enum Outcome { kSame = 0, kRefused = 3, kOther = 10, kLines = 11, kKind = 12, kMemory = 13 };

constexpr std::size_t kEdge = 8;
constexpr std::size_t kValues = kEdge * kEdge * kEdge;

void write_text_attribute(hid_t dataset) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(dataset, "units", type, space, H5P_DEFAULT, H5P_DEFAULT);
  const char* const text = "kelvin";
  EXPECT_GE(H5Awrite(attribute, type, static_cast<const void*>(&text)), 0);
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
}

std::string file_bytes(const std::string& path, const ChunkedShape& shape) {
  const Hdf5Lock lock;
  {
    const ChunkedFile file(path, shape);
    std::vector<float> values(kValues);
    for (std::size_t i = 0; i < kValues; ++i) values[i] = static_cast<float>(i % 37);
    file.write(H5T_NATIVE_FLOAT, values);
    write_text_attribute(file.dataset());
  }
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns the values that the library reads without weir; empty if it fails or there are not 8 x 8 x 8 values. Closes
/// no handle, because the process ends afterwards.
std::vector<float> read_by_library(const std::string& path) {
  const Hdf5Lock lock;
  std::vector<float> values(kValues);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, "d", H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset);
  const bool read = H5Sget_simple_extent_npoints(space) == static_cast<hssize_t>(kValues) &&
                    H5Dread(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  return read ? values : std::vector<float>();
}

Outcome read_file(const std::string& path) {
  try {
    const auto source = open_hdf5(path, {});
    if (source->info().domain().voxels() != static_cast<std::int64_t>(kValues)) return kSame;
    std::vector<float> values(kValues);
    tbb::task_arena(1).execute([&] { source->read(source->info().domain(), values); });  // fork() left only one thread
    const std::vector<float> by_library = read_by_library(path);
    const bool same = by_library.empty() || std::memcmp(values.data(), by_library.data(), sizeof(float) * kValues) == 0;
    return same ? kSame : kOther;
  } catch (const Error& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) return kLines;
    return error.kind() == ErrorKind::input ? kRefused : kKind;
  } catch (const std::bad_alloc&) {
    return kMemory;
  }
}

/// Reads the file in a child process. Returns the status of the child as waitpid() gives it.
int status_of_reading(const std::string& path) {
  const pid_t child = ::fork();
  if (child == 0) {
    const struct rlimit memory { 4UL << 30U, 4UL << 30U };
    ::setrlimit(RLIMIT_AS, &memory);
    [[maybe_unused]] const auto* const quiet = std::freopen("/dev/null", "w", stderr);
    report_hdf5_crashes(std::chrono::milliseconds(200));
    watch_hdf5_reads(hdf5_reads());
    const Hdf5Call call(path);
    ::_exit(read_file(path));
  }
  int status = -1;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return status;
}

void expect_reads_or_refuses(const std::string& path, const std::string& bytes, const std::string& what) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  const int status = status_of_reading(path);
  EXPECT_TRUE(WIFEXITED(status) && (WEXITSTATUS(status) == kSame || WEXITSTATUS(status) == kRefused))
      << what << ": " << (WIFEXITED(status) ? "exit " : "signal ")
      << (WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status));
}

class Hdf5Mutation : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "the sanitizer handles these signals, and the library's faults are its own";
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "a.h5";
};

TEST_F(Hdf5Mutation, OfAnyByte_EndsWithTheLibrarysValuesOrAnError) {
  constexpr int kOfEach = 24;
  const std::array<ChunkedShape, 4> shapes{
      {{{kEdge, kEdge, kEdge}, {4, 4, 4}, {}},
       {{kEdge, kEdge, kEdge}, {4, 5, 8}, {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}},
       {{kEdge, kEdge, kEdge}, {4, 4, 4}, {H5Z_FILTER_FLETCHER32}, false, H5T_NATIVE_FLOAT, H5F_LIBVER_V110},
       {{kEdge, kEdge, kEdge}, {8, 8, 3}, {H5Z_FILTER_DEFLATE}, true, H5T_NATIVE_SHORT, H5F_LIBVER_EARLIEST}}};
  std::mt19937 random(1);
  const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random()) % end; };
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    const std::string whole = file_bytes(path_, shapes.at(s));
    ASSERT_GT(whole.size(), 2000U);
    for (int i = 0; i < kOfEach; ++i) {
      std::string bytes = whole;
      const std::size_t at = below(bytes.size() - 8);
      if (i % 3 == 0) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      if (i % 3 == 1) bytes.replace(at, 8, 8, below(2) == 0 ? '\0' : '\xFF');
      if (i % 3 == 2) bytes.replace(at, 4, bytes, below(bytes.size() - 4), 4);
      expect_reads_or_refuses(path_, bytes, "shape " + std::to_string(s) + ", at " + std::to_string(at));
    }
  }
}

// In `circle`, a node of the index of chunks is its own child: the library follows it until the stack ends. In
// `endless`, an object in the heap of texts has no bytes: HDF5 1.10 follows it for ever.
TEST_F(Hdf5Mutation, OfWhatLeadsInACircle_EndsWithAnError) {
  const std::string whole =
      file_bytes(path_, {{kEdge, kEdge, kEdge}, {4, 4, 4}, {}, false, H5T_NATIVE_FLOAT, H5F_LIBVER_EARLIEST});
  const auto patched = [&](std::string bytes, std::size_t at, std::uint64_t value, std::size_t count) {
    std::memcpy(bytes.data() + at, &value, count);  // little-endian, as all numbers in the file are
    return bytes;
  };
  const std::size_t node = whole.find(std::string("TREE\1", 5));
  const std::size_t heap = whole.find("GCOL");
  ASSERT_TRUE(node != std::string::npos && heap != std::string::npos);
  constexpr std::size_t kNodeHead = 24;
  constexpr std::size_t kKey = 8 + 8 * 4;
  constexpr std::size_t kHeapHead = 16;
  const std::string circle = patched(patched(whole, node + 5, 1, 1), node + kNodeHead + kKey, node, 8);
  const std::string endless = patched(patched(whole, heap + kHeapHead, 0, 2), heap + kHeapHead + 8, 0, 8);
  for (const std::string& bytes : {circle, endless}) {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
    const int status = status_of_reading(path_);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == kRefused) << status;
  }
}

}  // namespace
}  // namespace weir::hdf5_mutation_test
