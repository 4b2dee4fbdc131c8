// The loader's behaviour when the runtime of a pretended device refuses or fails in the middle of a load.
#include <gtest/gtest.h>
#include <pthread.h>

#include <cstddef>
#include <fstream>
#include <string>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/cuda/grid_loader.h"
#include "tests/cuda/support/grid_file.h"
#include "tests/fake_cuda/fake_runtime.h"
#include "tests/support/packed_grid.h"
#include "tests/support/temporary_directory.h"

namespace weir::grid_loader_fault_test {
namespace {

using test::FakeRuntime;

// While the object lives, no thread starts, because its stack would be larger than the address space.
class NoMoreThreads {
 public:
  NoMoreThreads() {
    pthread_getattr_default_np(&before_);
    pthread_attr_t attributes;
    pthread_getattr_default_np(&attributes);
    pthread_attr_setstacksize(&attributes, std::size_t{1} << 48U);
    EXPECT_EQ(pthread_setattr_default_np(&attributes), 0);
    pthread_attr_destroy(&attributes);
  }
  ~NoMoreThreads() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }
  NoMoreThreads(const NoMoreThreads&) = delete;
  NoMoreThreads& operator=(const NoMoreThreads&) = delete;

 private:
  pthread_attr_t before_{};
};

class GridLoaderFault : public testing::Test {
 protected:
  GridLoaderFault() { FakeRuntime::instance().reset(); }
  ~GridLoaderFault() override {
    // A device that failed for good gives nothing back.
    if (!runtime().broken()) {
      EXPECT_EQ(runtime().registered_bytes(), 0U);
      EXPECT_EQ(runtime().allocated_bytes(), 0U);
    }
    runtime().reset();
  }

  static FakeRuntime& runtime() { return FakeRuntime::instance(); }

  NvdbFile file(int edge = 40) const {
    const std::string path = directory_ / "grid.nvdb";
    test::write_grid_file(path, edge);
    return NvdbFile(path);
  }

  static bool holds(const DeviceGrid& grid, const NvdbFile& file) {
    const auto data = file.grid().data();
    return std::equal(data.begin(), data.end(), grid.data(), grid.data() + grid.bytes());
  }

  static std::string refusal(const NvdbFile& file, const LoadOptions& options = kOptions) {
    try {
      load_grid(file, {}, options);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io);
      return error.what();
    }
    return "none";
  }

  static inline const LoadOptions kOptions{
      .order = {LoadPath::registered, LoadPath::pinned_ring, LoadPath::pageable}, .chunk_bytes = 65536, .threads = 2};
  const TemporaryDirectory directory_;
};

TEST_F(GridLoaderFault, ARefusalAtAnyChunkLeadsToTheNextWay) {
  const NvdbFile grid_file = file();
  for (const cudaError_t code : {cudaErrorNotSupported, cudaErrorMemoryAllocation}) {
    for (const int chunk : {0, 1, 7}) {
      runtime().reset();
      runtime().fail("cudaHostRegister", chunk, code);
      const DeviceGrid grid = load_grid(grid_file, {}, kOptions);
      EXPECT_EQ(grid.report().path, LoadPath::pinned_ring);
      EXPECT_EQ(grid.report().note.rfind("not registered: registering ", 0), 0U) << grid.report().note;
      EXPECT_NE(grid.report().note.find(cat(" of the file: ", cudaGetErrorName(code), ", pretended")),
                std::string::npos)
          << grid.report().note;
      EXPECT_TRUE(holds(grid, grid_file));
      EXPECT_EQ(runtime().registered_bytes(), 0U);
      EXPECT_EQ(cudaGetLastError(), cudaSuccess);
    }
  }
}

TEST_F(GridLoaderFault, NullStream_IsTheCallersDefaultStreamNotTheThreadsOwn) {
  const NvdbFile grid_file = file();
  const DeviceGrid grid = load_grid(grid_file, {}, kOptions);
  EXPECT_TRUE(runtime().streams_named().contains(cudaStreamLegacy));
  EXPECT_FALSE(runtime().streams_named().contains(nullptr));
}

TEST_F(GridLoaderFault, APlainCopyIsTheLastResort) {
  const NvdbFile grid_file = file();
  runtime().set_attribute(cudaDevAttrHostRegisterReadOnlySupported, 0);
  runtime().fail("cudaHostAlloc", 0, cudaErrorMemoryAllocation);
  const DeviceGrid grid = load_grid(grid_file, {}, kOptions);
  EXPECT_EQ(grid.report().path, LoadPath::pageable);
  EXPECT_EQ(grid.report().note,
            "not registered: the device does not register read-only memory; not pinned-ring: page-locking 1.0 MiB of "
            "host memory: cudaErrorMemoryAllocation, pretended");
  EXPECT_TRUE(holds(grid, grid_file));
}

TEST_F(GridLoaderFault, TheWayAskedForIsNotReplaced) {
  const NvdbFile grid_file = file();
  runtime().set_attribute(cudaDevAttrHostRegisterReadOnlySupported, 0);
  EXPECT_EQ(refusal(grid_file, {.only = LoadPath::registered}),
            grid_file.path() +
                ": cannot be brought to the device: not registered: the device does not register read-only memory");
}

TEST_F(GridLoaderFault, StickyErrorDoesNotFallBackToTheNextWay) {
  const NvdbFile grid_file = file();
  for (const char* function : {"cudaHostRegister", "cudaMemcpyAsync", "cudaEventRecord", "cudaEventSynchronize",
                               "cudaEventCreateWithFlags", "cudaHostUnregister"}) {
    for (const int call : {0, 3}) {
      runtime().reset();
      runtime().fail(function, call, cudaErrorIllegalAddress);
      EXPECT_NE(refusal(grid_file).find(": cudaErrorIllegalAddress, pretended"), std::string::npos) << function;
    }
  }
}

// An illegal access of earlier work may surface in registration, with a code that looks like a refusal.
TEST_F(GridLoaderFault, EarlierAsynchronousErrorDoesNotFallBack) {
  const NvdbFile grid_file = file();
  runtime().fail("cudaHostRegister", 2, cudaErrorNotSupported, true);
  const std::string message = refusal(grid_file);
  // The thread that calls first after the failure sees it, so what it was about to do differs.
  EXPECT_EQ(message.find("cannot be brought to the device"), std::string::npos) << message;
  EXPECT_NE(message.find(": cudaErrorNotSupported, pretended"), std::string::npos) << message;
}

TEST_F(GridLoaderFault, TheBufferIsStillTheCallersAfterAFailure) {
  const NvdbFile grid_file = file();
  DeviceBuffer buffer;
  buffer.reserve(grid_file.grid().data_bytes());
  const std::byte* const at = buffer.data();
  runtime().fail("cudaMemcpyAsync", 1, cudaErrorIllegalAddress);
  EXPECT_THROW(load_grid(grid_file, std::move(buffer), kOptions), Error);
  EXPECT_EQ(buffer.data(), at);
  EXPECT_TRUE(holds(load_grid(grid_file, std::move(buffer), kOptions), grid_file));
}

TEST_F(GridLoaderFault, SaysThatTheDeviceHasNoRoom) {
  const NvdbFile grid_file = file();
  runtime().fail("cudaMallocAsync", 0, cudaErrorMemoryAllocation);
  EXPECT_EQ(refusal(grid_file), cat("allocating ", format_bytes(grid_file.grid().data_bytes()),
                                    " of device memory: cudaErrorMemoryAllocation, pretended"));
}

TEST_F(GridLoaderFault, NeverLocksMoreThanThreadsAndThreeChunks) {
  const NvdbFile grid_file = file(96);
  for (const int threads : {1, 2, 4}) {
    runtime().reset();
    LoadOptions options = kOptions;
    options.threads = threads;
    EXPECT_TRUE(holds(load_grid(grid_file, {}, options), grid_file));
    EXPECT_GT(runtime().calls("cudaHostRegister"), 40U);
    EXPECT_LE(runtime().most_registered_bytes(), (static_cast<std::uint64_t>(threads) + 3) * options.chunk_bytes);
  }
}

TEST_F(GridLoaderFault, ZeroCopyFallsBackToACopyInHostMemory) {
  const NvdbFile grid_file = file();
  runtime().fail("cudaHostRegister", 0, cudaErrorNotSupported);
  const DeviceGrid grid = load_grid(grid_file, {}, {.zero_copy = true});
  EXPECT_EQ(grid.report().path, LoadPath::pinned_ring);
  EXPECT_EQ(grid.report().note.rfind("not registered: registering ", 0), 0U) << grid.report().note;
  EXPECT_TRUE(holds(grid, grid_file));
}

// The runtime's context on a device, which cudaSetDevice makes and enters, differs from the caller's own.
TEST_F(GridLoaderFault, AllThreadsWorkInTheCallersContext) {
  const NvdbFile grid_file = file();
  for (const LoadPath path : {LoadPath::registered, LoadPath::pinned_ring, LoadPath::pageable}) {
    runtime().reset();
    runtime().set_devices(2);
    runtime().make_current(1);
    LoadOptions options = kOptions;
    options.only = path;
    const DeviceGrid grid = load_grid(grid_file, {}, options);
    EXPECT_TRUE(holds(grid, grid_file));
    EXPECT_EQ(runtime().current_device(), 1);
    EXPECT_EQ(runtime().calls("cudaSetDevice"), 0U) << load_path_name(path);
    EXPECT_TRUE(runtime().devices_in_use().empty()) << load_path_name(path);
  }
}

TEST_F(GridLoaderFault, NoThreadCanBeStarted_TheNextWayLoads) {
  const NvdbFile grid_file = file();
  const NoMoreThreads none;
  const DeviceGrid grid = load_grid(grid_file, {}, kOptions);
  EXPECT_EQ(grid.report().path, LoadPath::pinned_ring);
  EXPECT_EQ(grid.report().note, "not registered: no thread can be started: Resource temporarily unavailable");
  EXPECT_TRUE(holds(grid, grid_file));
}

TEST_F(GridLoaderFault, EventThatIsNotRecorded_PagesStayLockedWhileTheyAreCopied) {
  const NvdbFile grid_file = file();
  for (int round = 0; round < 100; ++round) {
    runtime().reset();
    runtime().fail("cudaEventRecord", round % 4, cudaErrorIllegalAddress);
    EXPECT_NE(refusal(grid_file), "none");
    EXPECT_EQ(runtime().unlocked_while_copied(), 0U);
  }
}

TEST_F(GridLoaderFault, KeepsTheRingForTheNextLoad) {
  const NvdbFile grid_file = file();
  LoadOptions options = kOptions;
  options.only = LoadPath::pinned_ring;
  DeviceGrid grid = load_grid(grid_file, {}, options);
  grid = load_grid(grid_file, std::move(grid).take_buffer(), options);
  EXPECT_EQ(runtime().calls("cudaHostAlloc"), 1U);
  EXPECT_EQ(runtime().calls("cudaMallocAsync"), 1U);
}

TEST_F(GridLoaderFault, APackedGridIsForThoseWhoDecodeIt) {
  test::PackedGridOptions options;
  options.domain = {{0, 0, 0}, {32, 16, 16}};
  options.stream = [](const Index3&) { return test::constant_stream(2); };
  const std::string path = directory_ / "packed.nvdb";
  const test::PackedBytes bytes = test::PackedGridBuilder::build(options).file;
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  const NvdbFile packed(path);
  try {
    load_grid(packed, {}, kOptions);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(error.what(), path +
                                ": is packed; the CUDA loader reads float, Fp4, Fp8, Fp16 and FpN grids; load it as "
                                "one of them, or convert it with --encoding float");
  }
  LoadOptions decoding = kOptions;
  decoding.packed = true;
  EXPECT_TRUE(holds(load_grid(packed, {}, decoding), packed));
}

}  // namespace
}  // namespace weir::grid_loader_fault_test
