// Failing reads of a pretended cuFile, and the messages about them.
#include "gpu/cuda/load/direct_storage.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "gpu/cuda/load/cufile.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/support/temporary_directory.h"

namespace weir::direct_storage_test {
namespace {

constexpr std::uint64_t kPiece = 4096;
constexpr std::uint64_t kPieces = 64;

std::atomic<int> reads{0};

// Returns a library that refuses all reads.
std::shared_ptr<const CuFile> refusing_library() {
  auto library = std::make_shared<CuFile>();
  library->handle_register = [](cufile::Handle*, cufile::FileDescription*) { return cufile::Status{0, 0}; };
  library->handle_deregister = [](cufile::Handle) {};
  library->read = [](cufile::Handle, void*, std::size_t, off_t, off_t) -> ssize_t {
    ++reads;
    return -5027;
  };
  return library;
}

TEST(DirectStorage, ReadAtTheEndOfTheFile_SaysWhereItEnds) {
  EXPECT_EQ(cufile::read_failure(0, 4096), "the file ends at byte 4096");
}

TEST(DirectStorage, FailedRead_SaysTheErrorOfTheSystemOrOfCuFile) {
  errno = EIO;
  EXPECT_EQ(cufile::read_failure(-1, 0), "Input/output error");
  EXPECT_EQ(cufile::read_failure(-5027, 0), "cuFile error 5027");
}

void expect_end_of_reads(int threads) {
  const TemporaryDirectory directory;
  const std::string path = directory / "grid.nvdb";
  std::ofstream(path, std::ios::binary) << std::string(kPieces * kPiece, 'v');
  const FileMapping file(path, ".nvdb");
  std::vector<std::byte> target(kPieces * kPiece);
  CopyTask task{file, 0, target.size(), target.data()};
  task.chunk_bytes = kPiece;
  task.threads = threads;
  reads = 0;
  const std::string refusal = DirectStorage(refusing_library()).copy(task).refusal;
  if (refusal.find("no direct reads of") != std::string::npos) GTEST_SKIP() << refusal;
  EXPECT_EQ(refusal, "GPUDirect Storage: reading " + path + ": cuFile error 5027");
  EXPECT_LE(reads, threads);
}

TEST(DirectStorage, RefusedRead_EndsThoseOfAllPieces) { expect_end_of_reads(1); }

// Other threads enter the caller's context. Without a device they fail, before or after the read does.
TEST(DirectStorage, RefusedReadOfOneThread_EndsThoseOfAllThreads) {
  WEIR_NEEDS_DEVICE();
  expect_end_of_reads(4);
}

}  // namespace
}  // namespace weir::direct_storage_test
