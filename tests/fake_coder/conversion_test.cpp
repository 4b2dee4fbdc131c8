// Conversions with packed blocks that a pretended device surveys and encodes: the bytes are those of the CPU, and if
// the device fails, the CPU continues.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "compressor/push/pushed_volume.h"
#include "format/base/error.h"
#include "gpu/cuda/encode/device_coder.h"
#include "gpu/packed/coder_choice.h"
#include "ingest/values/array_source.h"
#include "tests/compressor/support/hard_cases.h"
#include "tests/fake_coder/support.h"
#include "tests/fake_cuda/fake_runtime.h"
#include "tests/support/message_of_error.h"

namespace weir::fake_coder_test {
namespace {

using test::FakeRuntime;
using test::MemoryVolume;

class FakeCoder : public testing::Test {
 protected:
  FakeCoder() { runtime().reset(); }
  ~FakeCoder() override { runtime().reset(); }

  static FakeRuntime& runtime() { return FakeRuntime::instance(); }

  static std::unique_ptr<BlockCoder> coder() {
    return make_device_coder(0, [](const Error& error) { ADD_FAILURE() << error.what(); });
  }
};

TEST_F(FakeCoder, FilesHaveTheBytesOfTheCpuWhateverTheBudgetAndTheThreads) {
  const std::unique_ptr<BlockCoder> device = coder();
  for (const NamedBudget& c : budgets()) {
    for (const bool smooth : {true, false}) {
      SCOPED_TRACE(c.name + (smooth ? ", cloud" : ", turbulence"));
      MemoryVolume volume = smooth ? cloud() : turbulence();
      ConversionOptions options = with(c.budget);
      options.preview = c.name == "default" ? Preview::automatic : Preview::off;
      const Result expected = convert_by(nullptr, volume, options);
      for (const std::size_t threads : {1U, 3U}) {
        options.threads = threads;
        const std::uint64_t before = runtime().calls("cudaHostAlloc") + runtime().calls("cudaMemcpyAsync");
        const Result result = convert_by(device.get(), volume, options);
        EXPECT_EQ(result.file == expected.file, true) << "with " << threads << " threads";
        EXPECT_EQ(result.sidecar.file.digest, expected.sidecar.file.digest);
        EXPECT_EQ(result.sidecar.error.max_abs, expected.sidecar.error.max_abs);
        EXPECT_EQ(result.sidecar.error.psnr_db, expected.sidecar.error.psnr_db);
        EXPECT_EQ(result.notices, expected.notices);
        if (c.name != "lossless") {  // the device does some of the work
          EXPECT_GT(runtime().calls("cudaHostAlloc") + runtime().calls("cudaMemcpyAsync"), before);
        }
      }
    }
  }
}

// There are so many blocks that a sample of them is surveyed first, and all blocks get the rungs of a window.
TEST_F(FakeCoder, LargerVolumesWhoseLaddersHaveFewRungsHaveTheBytesOfTheCpu) {
  const std::unique_ptr<BlockCoder> device = coder();
  for (const bool smooth : {true, false}) {
    SCOPED_TRACE(smooth);
    const Box domain{{0, 0, 0}, {262, 205, 161}};
    MemoryVolume volume = smooth ? cloud(domain) : turbulence(domain);
    const ConversionOptions options = with(budget_of(Budget::Kind::rate, smooth ? 6.0 : 25.0));
    const Result expected = convert_by(nullptr, volume, options);
    const Result result = convert_by(device.get(), volume, options);
    EXPECT_EQ(result.file == expected.file, true);
  }
}

// A conversion interrupted in the survey is continued with the other back end.
TEST_F(FakeCoder, WhatOneBackendHasBegunAnotherOneEnds) {
  MemoryVolume volume = turbulence({{0, 0, 0}, {262, 205, 161}});
  ConversionOptions options = with(budget_of(Budget::Kind::rate, 12));
  const Result expected = convert_by(nullptr, volume, options);
  options.output = "out.nvdb";
  options.encoding = Encoding::packed;
  options.memory = std::uint64_t{4} << 30U;
  options.threads = 2;
  options.resume = Resume::on;
  options.save_interval_s = 0;
  const std::unique_ptr<BlockCoder> device = coder();
  test::CrashFileSystem files;
  std::atomic<bool> cancel{false};
  std::vector<std::string> notices;
  ConversionControl control;
  control.cancel = &cancel;
  control.coder = device.get();
  control.notice = [&](const Message& line) { notices.push_back(line.text()); };
  control.pass_advanced = [&](std::uint64_t done) { cancel = done >= std::uint64_t{8} << 20U; };
  EXPECT_TRUE(message_of_error(ErrorKind::interrupted, [&] {
                convert_volume(volume, options, control, files);
              }).starts_with("interrupted"));
  cancel = false;
  control.pass_advanced = {};
  control.coder = nullptr;
  convert_volume(volume, options, control, files);
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_TRUE(notices[0].starts_with("out.nvdb: continues a conversion that was interrupted")) << notices[0];
  EXPECT_EQ(files.content("out.nvdb") == expected.file, true);
}

TEST_F(FakeCoder, HardCasesHaveTheBytesOfTheCpu) {
  const std::unique_ptr<BlockCoder> device = coder();
  for (const test::HardCase& c : test::hard_cases()) {
    SCOPED_TRACE(c.name);
    MemoryVolume volume = c.make();
    for (const NonFinitePolicy policy : test::policies_of(volume)) {
      ConversionOptions options = with(budget_of(Budget::Kind::rate, 6));
      options.non_finite = policy;
      options.budget.kind = Budget::Kind::automatic;
      const Result expected = convert_by(nullptr, volume, options);
      const Result result = convert_by(device.get(), volume, options);
      EXPECT_EQ(result.file == expected.file, true);
    }
  }
}

TEST_F(FakeCoder, PushedVolumesHaveTheBytesOfTheCpu) {
  MemoryVolume volume = cloud();
  ConversionOptions options = with(budget_of(Budget::Kind::rate, 7));
  const Result expected = convert_by(nullptr, volume, options);
  const std::unique_ptr<BlockCoder> device = coder();
  test::CrashFileSystem files;
  options.output = "out.nvdb";
  options.encoding = Encoding::packed;
  ConversionControl control;
  control.coder = device.get();
  PushedVolume pushed(volume.info(), options, control, files, 2);
  pushed.slab(0, volume.info().extent.z, volume.values().data());
  const std::uint64_t before = runtime().calls("cudaMemcpyAsync");
  pushed.end();
  EXPECT_GT(runtime().calls("cudaMemcpyAsync"), before) << "streams are the device's";
  EXPECT_EQ(files.content("out.nvdb") == expected.file, true);
}

TEST_F(FakeCoder, WhereTheDeviceFailsTheCpuGoesOnAndSaysItOnce) {
  MemoryVolume volume = turbulence();
  const ConversionOptions options = with(budget_of(Budget::Kind::rate, 8));
  const Result expected = convert_by(nullptr, volume, options);
  struct Fault {
    const char* function;
    int nth;
    cudaError_t code;
    const char* name;
    bool sticky;
  };
  for (const Fault& fault :
       {Fault{"cudaMallocAsync", 0, cudaErrorMemoryAllocation, "cudaErrorMemoryAllocation", false},
        Fault{"cudaMallocAsync", 4, cudaErrorMemoryAllocation, "cudaErrorMemoryAllocation", false},
        Fault{"cudaHostAlloc", 0, cudaErrorMemoryAllocation, "cudaErrorMemoryAllocation", false},
        Fault{"cudaHostAlloc", 1, cudaErrorMemoryAllocation, "cudaErrorMemoryAllocation", false},
        Fault{"cudaStreamSynchronize", 2, cudaErrorIllegalAddress, "cudaErrorIllegalAddress", true},
        Fault{"cudaStreamSynchronize", 9, cudaErrorIllegalAddress, "cudaErrorIllegalAddress", true},
        Fault{"cudaMemcpyAsync", 0, cudaErrorIllegalAddress, "cudaErrorIllegalAddress", true},
        Fault{"cudaMemcpyAsync", 5, cudaErrorIllegalAddress, "cudaErrorIllegalAddress", false}}) {
    SCOPED_TRACE(std::string(fault.function) + ", call " + std::to_string(fault.nth));
    runtime().reset();
    std::vector<std::string> said;
    const std::unique_ptr<BlockCoder> device =
        choose_coder(CoderChoice::cuda, true, 0, [&](const Message& line) { said.push_back(line.text()); });
    runtime().fail(fault.function, fault.nth, fault.code, fault.sticky);
    const Result result = convert_by(device.get(), volume, options);
    EXPECT_EQ(result.file == expected.file, true);
    ASSERT_EQ(said.size(), 1U);
    EXPECT_TRUE(said[0].starts_with("the CUDA device has failed (")) << said[0];
    EXPECT_TRUE(said[0].ends_with(std::string(fault.name) + ", pretended); the CPU does its work, to the same bytes"))
        << said[0];
  }
}

TEST_F(FakeCoder, BackendsAreChosenByNameAndEncoding) {
  EXPECT_EQ(choose_coder(CoderChoice::cpu, true, kLeastMemoryOfDevice, {}), nullptr);
  EXPECT_EQ(choose_coder(CoderChoice::automatic, false, kLeastMemoryOfDevice, {}), nullptr);
  EXPECT_NE(choose_coder(CoderChoice::automatic, true, kLeastMemoryOfDevice, {}), nullptr);
  EXPECT_EQ(choose_coder(CoderChoice::automatic, true, kLeastMemoryOfDevice - 1, {}), nullptr);
  runtime().fail("cudaMallocAsync", 0, cudaErrorMemoryAllocation);
  std::vector<std::string> said;
  EXPECT_EQ(choose_coder(CoderChoice::automatic, true, kLeastMemoryOfDevice,
                         [&](const Message& line) { said.push_back(line.text()); }),
            nullptr);
  EXPECT_EQ(said.size(), 1U);
  runtime().fail("cudaMallocAsync", 0, cudaErrorMemoryAllocation);
  EXPECT_NE(message_of_error(ErrorKind::io, [] { choose_coder(CoderChoice::cuda, true, 0, {}); })
                .find("cudaErrorMemoryAllocation"),
            std::string::npos);
}

}  // namespace
}  // namespace weir::fake_coder_test
