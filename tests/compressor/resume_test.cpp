// What an interrupted conversion keeps, when it is continued, and when it is not.
#include "compressor/resume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "tests/compressor/support/resumed.h"

namespace weir::test {
namespace {

TEST_F(ResumeOfHoles, RefusedNonFiniteInputLeavesNoFiles) {
  CrashFileSystem files;
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
  CrashFileSystem files;
  EXPECT_EQ(interrupted(base(), files, "survey", 4 << 20), kKept);
  EXPECT_EQ(files.names(), (Names{kHidden + "journal", kHidden + "rows"}));
  const Result result = run(base(), files);
  ASSERT_EQ(result.notices.size(), 1U);
  EXPECT_TRUE(result.notices[0].starts_with("out.nvdb: continues a conversion that was interrupted, survey ") &&
              result.notices[0].ends_with(" %, encode 0 % done"))
      << result.notices[0];
  EXPECT_TRUE(files.content("out.nvdb") == expected.file);
  EXPECT_EQ(result.record, expected.record);
  // 4 MiB were surveyed; only a region that was not complete is read again. The second pass reads a little more or less
  // with blocks of another shape.
  EXPECT_LE(result.bytes_read, expected.bytes_read - (2 << 20));
}

TEST_F(ResumeTest, InterruptedEncodePassReadsTheRestOnly) {
  ConversionOptions options = base();
  options.budget.kind = Budget::Kind::lossless;
  const Result expected = undisturbed(options);
  const std::uint64_t dense = static_cast<std::uint64_t>(kDomain.voxels()) * sizeof(float);
  CrashFileSystem files;
  EXPECT_EQ(interrupted(options, files, "encode", dense / 2), kKept);
  EXPECT_EQ(files.names(), (Names{kHidden + "journal", kHidden + "records", kHidden + "rows", kHidden + "volume"}));
  files.lose_unflushed();
  const Result result = run(options, files);
  ASSERT_EQ(result.notices.size(), 1U);
  EXPECT_TRUE(
      result.notices[0].starts_with("out.nvdb: continues a conversion that was interrupted, survey 100 %, encode "))
      << result.notices[0];
  EXPECT_LE(result.bytes_read, dense / 2);
  EXPECT_TRUE(files.content("out.nvdb") == expected.file);
  EXPECT_EQ(files.names(), kResult);
}

// The saving thread writes a complete state, whatever the passes do at the same time.
TEST_F(ResumeTest, SavesBesideTheWorkCanBeContinuedFrom) {
  ConversionOptions options = base();
  options.threads = 2;
  const Result expected = undisturbed(options);
  options.save_interval_s = 1e-9;  // saves again as soon as the last save is over
  const int calls = calls_of(options);
  for (const int part : {1, 2, 3, 4}) {
    SCOPED_TRACE(part);
    CrashFileSystem files;
    if (!killed(options, files, calls * part / 5)) continue;
    files.lose_unflushed();
    options.overwrite = !files.content("out.nvdb").empty();  // needed if it was killed after the last rename
    run(options, files);
    EXPECT_EQ(files.names(), kResult);
    EXPECT_TRUE(files.content("out.nvdb") == expected.file);
    options.overwrite = false;
  }
}

TEST_F(ResumeTest, AutomaticResume_InterruptedSmallVolume_LeavesNoFiles) {
  ConversionOptions options = base();
  options.resume = Resume::automatic;
  CrashFileSystem files;
  EXPECT_EQ(interrupted(options, files, "survey", 4 << 20), "interrupted; nothing was written");
  EXPECT_EQ(files.names(), Names{});
}

TEST_F(ResumeTest, AnotherConversionStartsAnew) {
  CrashFileSystem files;
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
  CrashFileSystem files;
  EXPECT_EQ(interrupted(base(), files, "survey", 4 << 20), kKept);
  volume_.info().mtime_ns = 1;
  EXPECT_EQ(run(base(), files).notices, (Names{"out.nvdb: an interrupted conversion of it is not continued: source "
                                               "modified (ns) was \"0\", now \"1\""}));
}

TEST_F(ResumeTest, ResumeOff_RemovesLeftoverFiles) {
  CrashFileSystem files;
  EXPECT_EQ(interrupted(base(), files, "survey", 4 << 20), kKept);
  ConversionOptions options = base();
  options.resume = Resume::off;
  EXPECT_EQ(run(options, files).notices, (Names{"out.nvdb: what an interrupted conversion of it had left is removed"}));
  EXPECT_EQ(files.names(), kResult);
}

// The survey is kept, because it does not depend on the scene. Encoded leaves are not kept.
TEST_F(ResumeTest, ChangedScene_KeepsTheSurveyAndEncodesAgain) {
  ConversionOptions options = base();
  Scene scene;
  scene.volume.range = {-100, 110};
  scene.volume.opacity = {{0, 0}, {0.6, 0}, {0.8, 0.3}, {1, 1}};
  options.scene = SceneFile{scene, "s.toml"};
  CrashFileSystem files;
  EXPECT_EQ(interrupted(options, files, "encode", 1 << 20), kKept);
  options.scene->scene.volume.opacity = {{0, 1}, {0.2, 0}, {1, 0}};
  const Result result = run(options, files);
  EXPECT_LT(result.bytes_read, undisturbed(options).bytes_read);
  EXPECT_TRUE(files.content("out.nvdb") == undisturbed(options).file);
}

TEST_F(ResumeTest, ChangedScene_ErrorTarget_GivesTheUndisturbedBytes) {
  ConversionOptions options = base();
  options.budget = {Budget::Kind::psnr, 0, 0, 45};
  options.encoding = Encoding::fpn;
  Scene scene;
  scene.volume.range = {-100, 110};
  scene.volume.opacity = {{0, 0}, {0.6, 0}, {0.8, 0.3}, {1, 1}};
  options.scene = SceneFile{scene, "s.toml"};
  ConversionOptions edited = options;
  edited.scene->scene.volume.opacity = {{0, 1}, {0.2, 0}, {1, 0}};
  const Result expected = undisturbed(edited);
  const int calls = calls_of(options);
  for (const int part : {6, 7, 8, 9}) {  // in later attempts, too
    CrashFileSystem files;
    killed(options, files, calls * part / 10);
    edited.overwrite = !files.content("out.nvdb").empty();  // needed if it was killed after the last rename
    run(edited, files);
    EXPECT_TRUE(files.content("out.nvdb") == expected.file) << part;
  }
}

TEST_F(ResumeTest, DamagedStateStartsAnew) {
  const Result expected = undisturbed(base());
  const auto after = [&](const auto& damage) {
    CrashFileSystem files;
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
    return [at](CrashFileSystem& files) {
      const auto file = files.open(kHidden + "journal");
      std::array<std::byte, 1> byte{};
      const std::uint64_t place = at < file->size() ? at : file->size() - 1;
      file->read_at(place, byte);
      byte[0] ^= std::byte{1};
      file->write_at(place, byte);
    };
  };
  for (const std::size_t at : {0U, 20U, 50U, 51U, 300U, 4000000U}) EXPECT_EQ(after(flip(at)), broken) << at;
  EXPECT_EQ(after([](CrashFileSystem& files) { files.open(kHidden + "journal")->clear(); }), broken);
  const std::string missing = begin + "files that its journal names are missing or shorter";
  EXPECT_EQ(after([](CrashFileSystem& files) { files.remove(kHidden + "rows"); }), missing);
  EXPECT_EQ(after([](CrashFileSystem& files) { files.open(kHidden + "rows")->clear(); }), missing);
  EXPECT_EQ(after([](CrashFileSystem& files) { files.remove(kHidden + "journal"); }), "");
}

// Flips a bit of byte `at` of a file that an interrupted conversion has left.
void flip_bit(FileSystem& files, const std::string& path, std::uint64_t at) {
  const auto file = files.open(path);
  std::array<std::byte, 1> byte{};
  file->read_at(at, byte);
  byte[0] ^= std::byte{16};
  file->write_at(at, byte);
}

const std::string kSurveyedAgain = "out.nvdb: an interrupted conversion of it is not continued: ";
const std::string kEncodedAgain = "out.nvdb: what was encoded of it is encoded again: ";

// Whatever byte of any file is damaged, the output is that of an undisturbed conversion. If the output depends on the
// damaged byte, a notice says so.
class ResumeOfDamage : public ResumeTest {
 protected:
  using ResumeTest::ResumeTest;

  // Interrupts when `bytes` of the pass are done and damages one byte, for bytes all over the file. Returns for how
  // many of these bytes a notice reported the damage.
  int same_bytes(const ConversionOptions& options, const std::string& pass, std::uint64_t bytes,
                 const std::string& name, const std::string& reason) {
    constexpr std::uint64_t kPlaces = 5;
    const Result expected = undisturbed(options);
    int said = 0;
    for (std::uint64_t place = 0; place < kPlaces; ++place) {
      SCOPED_TRACE(cat(pass, ": ", name, ", place ", place));
      CrashFileSystem files;
      EXPECT_EQ(interrupted(options, files, pass, bytes), kKept);
      const std::uint64_t size = files.content(kHidden + name).size();
      flip_bit(files, kHidden + name, size * place / kPlaces);
      const Result result = run(options, files);
      EXPECT_TRUE(files.content("out.nvdb") == expected.file);
      EXPECT_EQ(result.record, expected.record);
      for (const std::string& notice : result.notices) {
        if (!notice.ends_with("is damaged")) continue;
        EXPECT_EQ(notice, cat(reason, kHidden, name, " is damaged"));
        ++said;
      }
    }
    return said;
  }
  void expect_same_bytes(const ConversionOptions& options, const std::string& pass, std::uint64_t bytes,
                         const std::string& name, const std::string& reason) {
    EXPECT_GE(same_bytes(options, pass, bytes, name, reason), 1) << pass << ": " << name;
  }
};

TEST_F(ResumeOfDamage, Float) {
  ConversionOptions options = base();
  expect_same_bytes(options, "survey", 4 << 20, "rows", kSurveyedAgain);
  options.budget.kind = Budget::Kind::lossless;
  const std::uint64_t half = static_cast<std::uint64_t>(kDomain.voxels()) * sizeof(float) / 2;
  expect_same_bytes(options, "encode", half, "rows", kSurveyedAgain);
  expect_same_bytes(options, "encode", half, "records", kEncodedAgain);
  expect_same_bytes(options, "encode", half, "volume", kEncodedAgain);
}

TEST_F(ResumeOfDamage, Quantised) {
  ConversionOptions options = base();
  options.encoding = Encoding::fpn;
  options.budget.rate = 5;
  expect_same_bytes(options, "encode", 4 << 20, "records", kEncodedAgain);
  expect_same_bytes(options, "encode", 4 << 20, "volume", kEncodedAgain);
}

// Of the requested 10 MiB, 3 MiB are in use.
TEST_F(ResumeOfDamage, Padding) {
  ConversionOptions options = base();
  options.encoding = Encoding::fp4;
  options.budget.kind = Budget::Kind::size;
  options.budget.bytes = 10 << 20;
  const Result expected = undisturbed(options);
  CrashFileSystem files;
  EXPECT_EQ(interrupted(options, files, "encode", 4 << 20), kKept);
  flip_bit(files, kHidden + "volume", options.budget.bytes - 1);
  const Names notices = run(options, files).notices;
  EXPECT_EQ(std::ranges::count(notices, cat(kEncodedAgain, kHidden, "volume is damaged")), 1);
  EXPECT_TRUE(files.content("out.nvdb") == expected.file);
}

TEST_F(ResumeOfDamage, Faces) {
  ConversionOptions options = base();
  Scene scene;
  scene.volume.range = {-100, 110};
  scene.volume.opacity = {{0, 0}, {0.6, 0}, {0.8, 0.3}, {1, 1}};
  options.scene = SceneFile{scene, "s.toml"};
  expect_same_bytes(options, "survey", 4 << 20, "faces", kSurveyedAgain);
  expect_same_bytes(options, "encode", 1 << 20, "faces", kSurveyedAgain);
}

TEST_F(ResumeOfDamage, Packed) {
  ConversionOptions options = base();
  options.encoding = Encoding::packed;
  options.memory = 12U << 20U;
  options.budget.rate = 12;
  expect_same_bytes(options, "survey", 4 << 20, "ladders", kSurveyedAgain);
  same_bytes(options, "encode", 4 << 20, "ladders", kSurveyedAgain);  // damage may not show: ladders are built again
  expect_same_bytes(options, "encode", 4 << 20, "records", kEncodedAgain);
}

TEST_F(ResumeOfDamage, PackedStreams) {
  ConversionOptions options = base();
  options.encoding = Encoding::packed;
  options.memory = 12U << 20U;
  options.budget.rate = 5;
  for (const Preview preview : {Preview::on, Preview::off}) {
    options.preview = preview;
    expect_same_bytes(options, "encode", 6 << 20, "volume", kEncodedAgain);
  }
}

// Ladders are built again after the survey, of blocks with missing values or of all blocks. This is no damage.
class ResumeOfDamagedHoles : public ResumeOfDamage {
 protected:
  ResumeOfDamagedHoles()
      : ResumeOfDamage([](const Index3& i) {
          const bool missing = i.x > -30 && (i.x * 7 + i.y * 13 + i.z * 29) % 317 == 0;
          return missing ? NAN : std::round(200 * ripples(i));
        }) {}
};

TEST_F(ResumeOfDamagedHoles, PackedNearlyLossless) {
  ConversionOptions options = base();
  options.encoding = Encoding::packed;
  options.memory = 12U << 20U;
  options.non_finite = NonFinitePolicy::background;
  for (const double rate : {4.0, 12.0}) {
    options.budget.rate = rate;
    CrashFileSystem files;
    EXPECT_EQ(interrupted(options, files, "encode", 4 << 20), kKept);
    const Result result = run(options, files);
    for (const std::string& notice : result.notices) EXPECT_EQ(notice.find("damaged"), std::string::npos) << notice;
  }
  expect_same_bytes(options, "survey", 4 << 20, "ladders", kSurveyedAgain);
}

TEST_F(ResumeTest, TooLittleMemory_KeepsTheSavedState) {
  CrashFileSystem files;
  EXPECT_EQ(interrupted(base(), files, "survey", 4 << 20), kKept);
  const Names kept = files.names();
  ConversionOptions options = base();
  options.memory = 1 << 20;
  EXPECT_THROW(convert_volume(volume_, options, {}, files), Error);
  EXPECT_EQ(files.names(), kept);
}

}  // namespace
}  // namespace weir::test
