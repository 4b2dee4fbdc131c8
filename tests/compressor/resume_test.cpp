// Conversions that die at any call to the file system, by a kill or with the
// machine, and are run again: the bytes are those of one that was not disturbed,
// and what was done is not done again.
#include "compressor/resume.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "compressor/conversion.h"
#include "format/error.h"
#include "tests/compressor/memory_file_system.h"
#include "tests/compressor/memory_volume.h"
#include "tests/support/faulty_file_system.h"

namespace weir {
namespace {

using test::MemoryFileSystem;
using test::MemoryVolume;
using Bytes = MemoryFileSystem::Bytes;
using Names = std::vector<std::string>;

const Names kResult{"out.nvdb", "out.nvdb.json"};
const std::string kHidden = "./.out.nvdb.work/";

// Ten blocks of a MiB, five regions, not on node borders.
constexpr Box kDomain{{-60, 3, 5}, {4, 64, 645}};

float ripples(const Index3& i) {
  const auto [x, y, z] = std::array{static_cast<double>(i.x), static_cast<double>(i.y), static_cast<double>(i.z)};
  return static_cast<float>(90 * std::sin(x / 9) * std::cos(y / 7 + z / 50) + 3 * std::sin(x * y) + z / 40);
}

// Blocks of the least size there is.
std::uint64_t least_memory(MemoryVolume& volume, std::size_t threads) {
  MemoryFileSystem files;
  ConversionOptions options;
  options.output = "out.nvdb";
  options.memory = 1;
  options.threads = threads;
  try {
    convert_volume(volume, options, {}, files);
  } catch (const Error& error) {
    const std::string text = error.what();
    return std::stoull(text.substr(text.rfind(' ') + 1)) << 20U;
  }
  ADD_FAILURE() << "a conversion in one byte";
  return 0;
}

// All but the seconds and bytes of this machine and run.
std::string record_of(Sidecar sidecar) {
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
  explicit ResumeTest(float (*value)(const Index3&) = ripples) : volume_(kDomain, value) {}

  ConversionOptions base() const {
    ConversionOptions options;
    options.output = "out.nvdb";
    options.resume = Resume::on;
    options.save_interval_s = 0;
    options.memory = 0;  // above the least there is
    options.threads = 1;
    return options;
  }

  Result run(ConversionOptions options, FileSystem& files) {
    options.memory += least_memory(volume_, options.threads);
    Result result;
    ConversionControl control;
    control.notice = [&](const std::string& line) { result.notices.push_back(line); };
    control.pass_started = [&](const std::string& pass, std::uint64_t) { result.encode_passes += pass == "encode"; };
    const std::uint64_t before = volume_.bytes_read();
    result.record = record_of(convert_volume(volume_, options, control, files));
    result.bytes_read = volume_.bytes_read() - before;
    return result;
  }

  Result undisturbed(ConversionOptions options) {
    MemoryFileSystem files;
    options.resume = Resume::off;
    Result result = run(options, files);
    EXPECT_EQ(files.names(), kResult);
    result.file = files.content("out.nvdb");
    return result;
  }

  // Number of calls to the file system.
  int calls_of(const ConversionOptions& options) {
    MemoryFileSystem memory;
    FaultyFileSystem files(memory, -1, 0);
    run(options, files);
    EXPECT_EQ(memory.names(), kResult) << "a conversion that ends leaves nothing";
    return static_cast<int>(files.calls().size());
  }

  // Runs until call `at`, as a killed process does; false where it ends before.
  bool killed(const ConversionOptions& options, MemoryFileSystem& memory, int at) {
    FaultyFileSystem files(memory, at, EIO, FaultyFileSystem::After::fails);
    try {
      run(options, files);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io) << error.what();
      return true;
    }
    return files.failed();
  }

  // Kills at about `points` calls, spread over the conversion, and goes on in another way.
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
      MemoryFileSystem memory;
      if (!killed(options, memory, at)) continue;
      if (i % 2 == 0) memory.lose_unflushed();
      // Every third one is killed a second time. Where it was killed between the two renames, or later, the user is
      // told to pass --overwrite.
      otherwise.overwrite = !memory.content("out.nvdb.json").empty();
      if (i % 3 == 0 && killed(otherwise, memory, calls / 5)) memory.lose_unflushed();
      ConversionOptions again = i % 4 == 0 ? options : otherwise;
      again.overwrite = !memory.content("out.nvdb.json").empty();
      const Result result = run(again, memory);
      EXPECT_EQ(memory.names(), kResult);
      EXPECT_TRUE(memory.content("out.nvdb") == expected.file);
      EXPECT_EQ(result.record, expected.record);
      if (result.bytes_read < expected.bytes_read) ++continued;
    }
    EXPECT_GT(continued, points / 2) << "so many had something to go on from";
  }

  // Interrupts once `bytes` of the pass `name` are done; returns the message.
  std::string interrupted(ConversionOptions options, FileSystem& files, const std::string& name, std::uint64_t bytes) {
    options.save_interval_s = 3600;  // only the interruption saves
    options.memory += least_memory(volume_, options.threads);
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

TEST_F(ResumeTest, Float) {
  ConversionOptions options = base();
  expect_same_bytes(options, 60);
}

TEST_F(ResumeTest, Quantised) {
  ConversionOptions options = base();
  options.encoding = Encoding::fpn;
  options.budget.kind = Budget::Kind::rate;
  options.budget.rate = 5;
  expect_same_bytes(options, 24);
}

TEST_F(ResumeTest, WhicheverEncodingIsBetter) {
  ConversionOptions options = base();
  options.encoding = Encoding::automatic;
  expect_same_bytes(options, 24);
}

TEST_F(ResumeTest, ErrorTargetOfSeveralAttempts) {
  ConversionOptions options = base();
  options.encoding = Encoding::fpn;
  options.budget.kind = Budget::Kind::psnr;
  options.budget.target = 43;
  EXPECT_GE(undisturbed(options).encode_passes, 2);
  expect_same_bytes(options, 40);
  options.budget.kind = Budget::Kind::max_error;
  options.budget.target = 0.5;
  EXPECT_EQ(undisturbed(options).encode_passes, 1);
  expect_same_bytes(options, 24);
}

TEST_F(ResumeTest, Scene) {
  ConversionOptions options = base();
  options.encoding = Encoding::automatic;
  Scene scene;
  scene.volume.range = {-100, 110};
  scene.volume.opacity = {{0, 0}, {0.6, 0}, {0.8, 0.3}, {1, 1}};
  options.scene = SceneFile{scene, "s.toml"};
  expect_same_bytes(options, 24);
}

class ResumeOfHoles : public ResumeTest {
 protected:
  ResumeOfHoles() : ResumeTest([](const Index3& i) { return i.z % 97 == 5 ? NAN : ripples(i); }) {}
};

TEST_F(ResumeOfHoles, ThePapersMethod) {
  ConversionOptions options = base();
  options.paper_background = true;
  options.metric = Metric::farthest;
  options.fill = FillMode::background;
  options.non_finite = NonFinitePolicy::background;
  expect_same_bytes(options, 24);
}

TEST_F(ResumeOfHoles, RefusalLeavesNothing) {
  MemoryFileSystem files;
  try {
    run(base(), files);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
  }
  EXPECT_EQ(files.names(), Names{});
}

constexpr std::string_view kKept =
    "interrupted; what is done is kept in ./.out.nvdb.work, the same command continues it";

TEST_F(ResumeTest, InterruptedSurveyReadsTheRestOnly) {
  const Result expected = undisturbed(base());
  MemoryFileSystem files;
  const std::uint64_t before = volume_.bytes_read();
  EXPECT_EQ(interrupted(base(), files, "survey", 4 << 20), kKept);
  EXPECT_EQ(files.names(), (Names{kHidden + "journal", kHidden + "rows"}));
  const Result result = run(base(), files);
  EXPECT_EQ(result.notices,
            (Names{"out.nvdb: continues a conversion that was interrupted, survey 49 %, encode 0 % done"}));
  EXPECT_TRUE(files.content("out.nvdb") == expected.file);
  EXPECT_EQ(result.record, expected.record);
  // The block that was being read meanwhile is read twice.
  EXPECT_LE(volume_.bytes_read() - before, expected.bytes_read + (2 << 20));
  EXPECT_LE(result.bytes_read, expected.bytes_read - (4 << 20));
}

TEST_F(ResumeTest, InterruptedEncodePassReadsTheRestOnly) {
  ConversionOptions options = base();
  options.budget.kind = Budget::Kind::lossless;
  const Result expected = undisturbed(options);
  const std::uint64_t dense = static_cast<std::uint64_t>(kDomain.voxels()) * sizeof(float);
  MemoryFileSystem files;
  EXPECT_EQ(interrupted(options, files, "encode", dense / 2), kKept);
  EXPECT_EQ(files.names(), (Names{kHidden + "journal", kHidden + "records", kHidden + "rows", kHidden + "volume"}));
  files.lose_unflushed();
  const Result result = run(options, files);
  ASSERT_EQ(result.notices.size(), 1U);
  EXPECT_TRUE(
      result.notices[0].starts_with("out.nvdb: continues a conversion that was interrupted, survey 100 %, encode 5"))
      << result.notices[0];
  EXPECT_LE(result.bytes_read, dense / 2);
  EXPECT_TRUE(files.content("out.nvdb") == expected.file);
  EXPECT_EQ(files.names(), kResult);
}

TEST_F(ResumeTest, SmallVolumesPayNothingAndLeaveNothing) {
  ConversionOptions options = base();
  options.resume = Resume::automatic;
  MemoryFileSystem files;
  EXPECT_EQ(interrupted(options, files, "survey", 4 << 20), "interrupted");
  EXPECT_EQ(files.names(), Names{});
}

TEST_F(ResumeTest, AnotherConversionStartsAnew) {
  MemoryFileSystem files;
  EXPECT_EQ(interrupted(base(), files, "survey", 4 << 20), kKept);
  ConversionOptions options = base();
  options.metric = Metric::median;
  const Result result = run(options, files);
  EXPECT_EQ(result.notices, (Names{"out.nvdb: an interrupted conversion of it is not continued: metric was \"sse\", "
                                   "now \"median\""}));
  EXPECT_EQ(files.names(), kResult);
  EXPECT_TRUE(files.content("out.nvdb") == undisturbed(options).file);
}

TEST_F(ResumeTest, AChangedSourceStartsAnew) {
  MemoryFileSystem files;
  EXPECT_EQ(interrupted(base(), files, "survey", 4 << 20), kKept);
  volume_.info().mtime_ns = 1;
  EXPECT_EQ(run(base(), files).notices, (Names{"out.nvdb: an interrupted conversion of it is not continued: source "
                                               "modified (ns) was \"0\", now \"1\""}));
}

TEST_F(ResumeTest, OffRemovesWhatWasLeft) {
  MemoryFileSystem files;
  EXPECT_EQ(interrupted(base(), files, "survey", 4 << 20), kKept);
  ConversionOptions options = base();
  options.resume = Resume::off;
  EXPECT_EQ(run(options, files).notices, (Names{"out.nvdb: what an interrupted conversion of it had left is removed"}));
  EXPECT_EQ(files.names(), kResult);
}

// The survey is kept: it does not depend on the scene. What was encoded is not.
TEST_F(ResumeTest, ASceneThatSaysSomethingElseIsEncodedAnew) {
  ConversionOptions options = base();
  Scene scene;
  scene.volume.range = {-100, 110};
  scene.volume.opacity = {{0, 0}, {0.6, 0}, {0.8, 0.3}, {1, 1}};
  options.scene = SceneFile{scene, "s.toml"};
  MemoryFileSystem files;
  EXPECT_EQ(interrupted(options, files, "encode", 1 << 20), kKept);
  options.scene->scene.volume.opacity = {{0, 1}, {0.2, 0}, {1, 0}};
  const Result result = run(options, files);
  EXPECT_LT(result.bytes_read, undisturbed(options).bytes_read);
  EXPECT_TRUE(files.content("out.nvdb") == undisturbed(options).file);
}

TEST_F(ResumeTest, DamagedStateStartsAnew) {
  const Result expected = undisturbed(base());
  const auto after = [&](const auto& damage) {
    MemoryFileSystem files;
    interrupted(base(), files, "survey", 4 << 20);
    damage(files);
    const Result result = run(base(), files);
    EXPECT_TRUE(files.content("out.nvdb") == expected.file);
    EXPECT_EQ(files.names(), kResult);
    return result.notices.empty() ? "" : result.notices[0];
  };
  const std::string begin = "out.nvdb: an interrupted conversion of it is not continued: ";
  const std::string broken = begin + "its journal is damaged or of another version of weir";
  const auto flip = [](std::size_t at) {
    return [at](MemoryFileSystem& files) {
      const auto file = files.open(kHidden + "journal");
      std::array<std::byte, 1> byte{};
      const std::uint64_t place = at < file->size() ? at : file->size() - 1;
      file->read_at(place, byte);
      byte[0] ^= std::byte{1};
      file->write_at(place, byte);
    };
  };
  for (const std::size_t at : {0U, 20U, 50U, 51U, 300U, 4000000U}) EXPECT_EQ(after(flip(at)), broken) << at;
  EXPECT_EQ(after([](MemoryFileSystem& files) { files.open(kHidden + "journal")->clear(); }), broken);
  const std::string missing = begin + "files that its journal names are missing or shorter";
  EXPECT_EQ(after([](MemoryFileSystem& files) { files.remove(kHidden + "rows"); }), missing);
  EXPECT_EQ(after([](MemoryFileSystem& files) { files.open(kHidden + "rows")->clear(); }), missing);
  EXPECT_EQ(after([](MemoryFileSystem& files) { files.remove(kHidden + "journal"); }), "");
}

TEST_F(ResumeTest, TooLittleMemoryKeepsWhatIsDone) {
  MemoryFileSystem files;
  EXPECT_EQ(interrupted(base(), files, "survey", 4 << 20), kKept);
  const Names kept = files.names();
  ConversionOptions options = base();
  options.memory = 1 << 20;
  EXPECT_THROW(convert_volume(volume_, options, {}, files), Error);
  EXPECT_EQ(files.names(), kept);
}

}  // namespace
}  // namespace weir
