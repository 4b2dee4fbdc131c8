// Conversions of volumes in the memory of a pretended device. The bytes are those of the same values in host memory,
// and the values are not copied there. If the device fails, they are read.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compressor/push/pushed_volume.h"
#include "compressor/push/resident_source.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/cuda/encode/resident_volume.h"
#include "tests/compressor/support/hard_cases.h"
#include "tests/fake_coder/support.h"
#include "tests/fake_cuda/fake_runtime.h"
#include "tests/support/message_of_error.h"
#include "tests/support/row_survey.h"

namespace weir::fake_coder_test {
namespace {

using test::FakeRuntime;
using test::MemoryVolume;

// Returns the message with which `action` is refused; empty if it is not refused.
template <typename Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

class Resident : public testing::Test {
 protected:
  Resident() { runtime().reset(); }
  ~Resident() override { runtime().reset(); }

  static FakeRuntime& runtime() { return FakeRuntime::instance(); }

  static void no_failure(const Error& error) { ADD_FAILURE() << error.what(); }

  // `volume` must outlive the returned source.
  static std::unique_ptr<VolumeSource> on_device(MemoryVolume& volume,
                                                 std::function<void(const Error&)> failed = no_failure) {
    return open_resident(make_resident_volume(0, volume.values().data(), volume.info().domain(), std::move(failed)),
                         volume.info());
  }
};

TEST_F(Resident, FilesHaveTheBytesOfTheHostWhateverTheBudgetAndTheThreads) {
  for (const NamedBudget& c : budgets()) {
    for (const bool smooth : {true, false}) {
      SCOPED_TRACE(c.name + (smooth ? ", cloud" : ", turbulence"));
      MemoryVolume volume = smooth ? cloud() : turbulence();
      ConversionOptions options = with(c.budget);
      options.resume = Resume::off;
      options.preview = c.name == "default" ? Preview::on : Preview::off;
      const Result expected = convert_by(nullptr, volume, options);
      for (const std::size_t threads : {1U, 3U}) {
        options.threads = threads;
        const std::unique_ptr<VolumeSource> source = on_device(volume);
        const Result result = convert_by(nullptr, *source, options);
        EXPECT_EQ(result.file == expected.file, true) << "with " << threads << " threads";
        EXPECT_EQ(result.sidecar.source.digest, expected.sidecar.source.digest);
        EXPECT_EQ(result.sidecar.error.max_abs, expected.sidecar.error.max_abs);
        EXPECT_EQ(result.sidecar.error.psnr_db, expected.sidecar.error.psnr_db);
        EXPECT_EQ(result.notices, expected.notices);
      }
    }
  }
}

// There are so many blocks that a sample of them is surveyed first. Nothing is read if the background is given.
TEST_F(Resident, ValuesOfALargerVolumeStayOnTheDevice) {
  for (const bool smooth : {true, false}) {
    SCOPED_TRACE(smooth);
    const Box domain{{0, 0, 0}, {272, 208, 160}};
    MemoryVolume volume = smooth ? cloud(domain) : turbulence(domain);
    ConversionOptions options = with(budget_of(Budget::Kind::rate, smooth ? 6.0 : 25.0));
    options.resume = Resume::off;
    options.background = 0.0F;
    const Result expected = convert_by(nullptr, volume, options);
    const std::unique_ptr<VolumeSource> source = on_device(volume);
    const Result result = convert_by(nullptr, *source, options);
    EXPECT_EQ(result.file == expected.file, true);
    EXPECT_EQ(source->bytes_read(), 0U);
  }
}

TEST_F(Resident, RowsOfBlocksAreSurveyedAsInABox) {
  const MemoryVolume volume = cloud();
  const auto resident = make_resident_volume(0, volume.values().data(), kOdd, no_failure);
  test::expect_rows_surveyed_as_in_a_box(*resident);
}

// A row of blocks is processed in parts. In both parts the device leaves some blocks to the host: those with NaN, and
// those that extend beyond the volume.
TEST_F(Resident, ARowOfManyBlocksGivesTheSameFileAsOnTheHost) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  MemoryVolume volume({{-3, 5, 130}, {1100, 21, 147}}, [&](const Index3& i) {
    const bool without_value = (i.x == 40 || i.x == 1050) && i.y < 12;
    return without_value ? kNaN : static_cast<float>(std::max(0.0, waves(i, 5)));
  });
  for (const NamedBudget& c : budgets()) {
    SCOPED_TRACE(c.name);
    ConversionOptions options = with(c.budget);
    options.resume = Resume::off;
    options.non_finite = NonFinitePolicy::keep;
    const Result expected = convert_by(nullptr, volume, options);
    const std::unique_ptr<VolumeSource> source = on_device(volume);
    EXPECT_EQ(convert_by(nullptr, *source, options).file == expected.file, true);
  }
}

// The device's memory is freed after a file is encoded, and allocated again.
TEST_F(Resident, OneVolumeIsConvertedTwice) {
  MemoryVolume volume = turbulence();
  const std::unique_ptr<VolumeSource> source = on_device(volume);
  for (const double rate : {8.0, 30.0}) {
    ConversionOptions options = with(budget_of(Budget::Kind::rate, rate));
    options.resume = Resume::off;
    const Result expected = convert_by(nullptr, volume, options);
    const Result result = convert_by(nullptr, *source, options);
    EXPECT_EQ(result.file == expected.file, true) << "rate " << rate;
  }
}

// The values that the scene shows have their own certificate.
TEST_F(Resident, ASceneGivesTheSameFileAndTheSameErrorOfWhatIsSeen) {
  MemoryVolume volume = turbulence();
  Scene scene;
  scene.volume.range = {-60, 60};
  scene.volume.opacity = {{0, 0}, {0.55, 0}, {0.7, 0.3}, {1, 1}};
  ConversionOptions options = with(budget_of(Budget::Kind::rate, 12));
  options.scene = SceneFile{scene, "s.toml"};
  options.resume = Resume::off;
  const Result expected = convert_by(nullptr, volume, options);
  const Result result = convert_by(nullptr, *on_device(volume), options);
  EXPECT_EQ(result.file == expected.file, true);
  ASSERT_TRUE(result.sidecar.visible && expected.sidecar.visible);
  EXPECT_LT(result.sidecar.visible->error.max_abs, result.sidecar.error.max_abs);
  EXPECT_EQ(result.sidecar.visible->error.max_abs, expected.sidecar.visible->error.max_abs);
  EXPECT_EQ(result.sidecar.visible->error.rmse, expected.sidecar.visible->error.rmse);
}

// Budgets that afford all near rungs and ordered floats, and budgets with the near rungs of a window.
TEST_F(Resident, NearlyLosslessBlocksOfACloudStayOnTheDevice) {
  MemoryVolume volume = cloud({{0, 0, 0}, {272, 208, 160}});
  for (const Budget& budget : {budget_of(Budget::Kind::rate, 3), budget_of(Budget::Kind::psnr, 130)}) {
    ConversionOptions options = with(budget);
    options.resume = Resume::off;
    options.background = 0.0F;
    options.preview = Preview::off;
    const Result expected = convert_by(nullptr, volume, options);
    const std::uint64_t before = values_copied();
    const Result result = convert_by(nullptr, *on_device(volume), options);
    EXPECT_EQ(result.file == expected.file, true);
    const auto& [none, mean, transform, lattice, raw] = *result.sidecar.selection.blocks;
    EXPECT_GT(lattice, transform);
    EXPECT_LT(values_copied() - before, lattice / 8) << "those on a lattice of their own";
  }
}

TEST_F(Resident, HardCasesHaveTheBytesOfTheHost) {
  for (const test::HardCase& c : test::hard_cases()) {
    SCOPED_TRACE(c.name);
    MemoryVolume volume = c.make();
    for (const NonFinitePolicy policy : test::policies_of(volume)) {
      for (const Budget& budget : {Budget{}, budget_of(Budget::Kind::rate, 6)}) {
        ConversionOptions options = with(budget);
        options.non_finite = policy;
        options.resume = Resume::off;
        Result expected;
        const std::string refusal = message_of([&] { expected = convert_by(nullptr, volume, options); });
        const std::unique_ptr<VolumeSource> source = on_device(volume);
        Result result;
        EXPECT_EQ(message_of([&] { result = convert_by(nullptr, *source, options); }), refusal);
        EXPECT_EQ(result.file == expected.file, true);
      }
    }
  }
}

TEST_F(Resident, WhereTheDeviceHasNoRoomTheHostDoesItsWorkAndSaysItOnce) {
  MemoryVolume volume = turbulence();
  ConversionOptions options = with(budget_of(Budget::Kind::rate, 8));
  options.resume = Resume::off;
  const Result expected = convert_by(nullptr, volume, options);
  for (const char* function : {"cudaMallocAsync", "cudaHostAlloc"}) {
    int failures = 0;
    for (const int nth : {0, 1, 3, 6, 9, 12}) {
      SCOPED_TRACE(std::string(function) + ", call " + std::to_string(nth));
      runtime().reset();
      std::vector<std::string> said;
      const std::unique_ptr<VolumeSource> source =
          on_device(volume, [&](const Error& error) { said.emplace_back(error.what()); });
      runtime().fail(function, nth, cudaErrorMemoryAllocation);
      const Result result = convert_by(nullptr, *source, options);
      EXPECT_EQ(result.file == expected.file, true);
      ASSERT_LE(said.size(), 1U);
      if (said.empty()) continue;
      ++failures;
      EXPECT_NE(said[0].find("cudaErrorMemoryAllocation"), std::string::npos) << said[0];
    }
    EXPECT_GE(failures, 2) << function;
  }
}

TEST_F(Resident, ADeviceThatIsGoneEndsTheConversionAndLeavesNothing) {
  MemoryVolume volume = turbulence();
  struct Fault {
    const char* function;
    int nth;
  };
  for (const Fault& fault :
       {Fault{"cudaStreamSynchronize", 0}, Fault{"cudaStreamSynchronize", 2}, Fault{"cudaStreamSynchronize", 5},
        Fault{"cudaEventSynchronize", 0}, Fault{"cudaEventSynchronize", 2}, Fault{"cudaEventRecord", 1}}) {
    SCOPED_TRACE(cat(fault.function, ", call ", fault.nth));
    runtime().reset();
    std::vector<std::string> said;
    const std::unique_ptr<VolumeSource> source =
        on_device(volume, [&](const Error& error) { said.emplace_back(error.what()); });
    runtime().fail(fault.function, fault.nth, cudaErrorIllegalAddress, true);
    ConversionOptions options = with(budget_of(Budget::Kind::rate, 8));
    options.resume = Resume::off;
    options.output = "out.nvdb";
    options.encoding = Encoding::packed;
    options.memory = std::uint64_t{4} << 30U;
    test::CrashFileSystem files;
    const std::string message = message_of_error(ErrorKind::io, [&] { convert_volume(*source, options, {}, files); });
    EXPECT_NE(message.find("cudaErrorIllegalAddress"), std::string::npos) << message;
    EXPECT_TRUE(files.names().empty());
    EXPECT_LE(said.size(), 1U);
  }
}

// A sample of the blocks is surveyed before the others and apart from them. The second volume has boxes that begin
// within a row of the sample.
TEST_F(Resident, OfALargerVolumeTheHostDoesWhatTheDeviceHasNoRoomFor) {
  for (const Box& domain : {Box{{0, 0, 0}, {256, 136, 136}}, Box{{3, 0, 0}, {65'700, 15, 14}}}) {
    MemoryVolume volume = turbulence(domain);
    ConversionOptions options = with(budget_of(Budget::Kind::rate, 20));
    options.resume = Resume::off;
    const Result expected = convert_by(nullptr, volume, options);
    int failures = 0;
    for (const int nth : {0, 6, 1'000'000}) {
      SCOPED_TRACE(cat(domain.hi.x, " voxels along x, call ", nth));
      runtime().reset();
      int said = 0;
      const std::unique_ptr<VolumeSource> source = on_device(volume, [&](const Error&) { ++said; });
      runtime().fail("cudaMallocAsync", nth, cudaErrorMemoryAllocation);
      const Result result = convert_by(nullptr, *source, options);
      EXPECT_EQ(result.file == expected.file, true);
      EXPECT_EQ(result.sidecar.source.digest, expected.sidecar.source.digest);
      EXPECT_EQ(result.sidecar.error.psnr_db, expected.sidecar.error.psnr_db);
      failures += said;
    }
    EXPECT_GE(failures, 2);
  }
}

// As a push on a device works: all planes are expected and arrive at the end.
TEST_F(Resident, APushEndsWithAVolumeOnTheDevice) {
  MemoryVolume volume = cloud({{0, 0, 0}, {61, 40, 33}});
  ConversionOptions options = with(budget_of(Budget::Kind::rate, 7));
  options.resume = Resume::off;
  const Result expected = convert_by(nullptr, volume, options);
  const std::unique_ptr<VolumeSource> whole = on_device(volume);
  test::CrashFileSystem files;
  options.output = "out.nvdb";
  options.encoding = Encoding::packed;
  options.memory = std::uint64_t{1} << 30U;
  PushedVolume pushed(volume.info(), options, {}, files, 1);
  pushed.expect(0, 20);
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { pushed.end(*whole); }),
            "memory: planes 20 to 32 of 33 never came; give the rest first");
  pushed.expect(20, 13);
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { pushed.end(); }),
            "memory: 33 planes are still expected; end once their values have come");
  pushed.end(*whole);
  EXPECT_EQ(files.content("out.nvdb") == expected.file, true);
  EXPECT_EQ(files.names(), (std::vector<std::string>{"out.nvdb", "out.nvdb.json"}));
}

}  // namespace
}  // namespace weir::fake_coder_test
