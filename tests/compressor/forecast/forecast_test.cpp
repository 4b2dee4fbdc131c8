// Compares the forecast of a conversion with the conversion itself.
#include "compressor/forecast/forecast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "compressor/conversion_memory.h"
#include "compressor/forecast/sample_plan.h"
#include "tests/compressor/support/memory_volume.h"
#include "tests/support/faulty_file_system.h"
#include "tests/support/message_of_error.h"
#include "tests/support/run_command.h"

namespace weir::forecast_test {
namespace {

using test::MemoryVolume;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

// Noise in [0, 1).
float noise(const Index3& i) {
  auto z = static_cast<std::uint64_t>(i.x + 4096 * (i.y + 4096 * i.z)) * 0x9E3779B97F4A7C15U;
  z = (z ^ z >> 30U) * 0xBF58476D1CE4E5B9U;
  z = (z ^ z >> 27U) * 0x94D049BB133111EBU;
  return static_cast<float>(static_cast<double>(z >> 40U) * 0x1p-24);
}

// One half is empty; the other half is noise below and waves above. So the parts cost differently.
float uneven(const Index3& i) {
  if (i.x < 100) return 0;
  if (i.z < 60) return noise(i);
  return 0.5F + 0.5F * std::sin(0.05F * static_cast<float>(i.x) + 0.11F * static_cast<float>(i.y * i.z) / 64);
}

MemoryVolume& uneven_volume() {
  static MemoryVolume volume({{0, 0, 0}, {200, 256, 256}}, uneven);
  return volume;
}

MemoryVolume volume_with_nan_in_every_block() {
  return MemoryVolume({{0, 0, 0}, {128, 256, 256}}, [](const Index3& i) {
    return i.x % 8 == 3 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(i.y);
  });
}

class ForecastTest : public testing::Test {
 protected:
  ConversionOptions options(Encoding encoding, Budget::Kind kind, double target = 0) const {
    ConversionOptions options;
    options.output = directory_ / "out.nvdb";
    options.memory = std::uint64_t{4} << 30U;
    options.threads = 2;
    options.encoding = encoding;
    options.budget.kind = kind;
    options.budget.target = target;
    return options;
  }
  Forecast forecast(VolumeSource& volume, const ConversionOptions& options, std::uint64_t most_bytes) {
    const Forecast forecast = forecast_conversion(volume, options, {}, *files_, most_bytes);
    EXPECT_TRUE(list_directory(directory_.path()).empty());
    return forecast;
  }
  Sidecar convert(VolumeSource& volume, ConversionOptions options) {
    options.output = other_ / "out.nvdb";
    options.overwrite = true;
    return convert_volume(volume, options, {}, *files_);
  }

  TemporaryDirectory directory_;
  TemporaryDirectory other_;
  std::unique_ptr<FileSystem> files_ = make_posix_file_system();
};

TEST_F(ForecastTest, SmallVolume_HasExactFigures) {
  MemoryVolume volume({{-5, 0, 3}, {195, 110, 73}}, uneven);
  struct Case {
    Encoding encoding;
    Budget::Kind kind;
    double target;
  };
  for (const Case& c :
       {Case{Encoding::automatic, Budget::Kind::automatic, 0}, Case{Encoding::float32, Budget::Kind::rate, 0},
        Case{Encoding::fpn, Budget::Kind::psnr, 45}, Case{Encoding::packed, Budget::Kind::rate, 0},
        Case{Encoding::packed, Budget::Kind::psnr, 50}, Case{Encoding::automatic, Budget::Kind::max_error, 0.01},
        Case{Encoding::automatic, Budget::Kind::lossless, 0}}) {
    const ConversionOptions asked = options(c.encoding, c.kind, c.target);
    const Forecast f = forecast(volume, asked, kForecastBytes);
    const std::uint64_t read_before = volume.bytes_read();
    const Sidecar made = convert(volume, asked);
    EXPECT_TRUE(f.whole);
    EXPECT_TRUE(f.exact_bytes);
    EXPECT_EQ(f.parts, 0U);
    EXPECT_EQ(f.file_bytes.value, static_cast<double>(made.file.bytes));
    EXPECT_EQ(f.budget, made.budget.kind);
    EXPECT_EQ(f.error.lossless, made.error.lossless);
    EXPECT_EQ(f.error.psnr_db.has_value(), made.error.psnr_db.has_value());
    if (f.error.psnr_db) {
      EXPECT_EQ(f.error.psnr_db->value, *made.error.psnr_db);
    }
    EXPECT_EQ(f.error.rmse, made.error.rmse);
    EXPECT_EQ(f.error.max_abs, made.error.max_abs);
    EXPECT_EQ(f.read_bytes, made.timing.bytes_read - read_before);
    EXPECT_EQ(f.volume_bytes, static_cast<std::uint64_t>(200 * 110 * 70 * 4));
    EXPECT_EQ(f.scratch_bytes, 0U);  // memory holds the records
    EXPECT_GT(f.survey_s, 0);
    EXPECT_GT(f.encode_s, 0);
    EXPECT_EQ(f.threads, 2U);
    EXPECT_EQ(f.encoding == "packed", c.encoding == Encoding::packed);
  }
}

TEST_F(ForecastTest, RecordsThatMemoryDoesNotHold_AreScratch) {
  MemoryVolume volume({{0, 0, 0}, {64, 64, 64}}, uneven);
  ConversionOptions asked = options(Encoding::packed, Budget::Kind::rate);
  const std::uint64_t records = record_bytes(asked, volume.info().domain());
  EXPECT_GE(records, 512U * (64 + 120 + 144));
  const Forecast held = forecast(volume, asked, kForecastBytes);
  EXPECT_EQ(held.scratch_bytes, 0U);
  asked.resume = Resume::on;  // another process must be able to find the records
  const Forecast spilled = forecast(volume, asked, kForecastBytes);
  EXPECT_EQ(spilled.scratch_bytes, records);
}

TEST_F(ForecastTest, SampleOfUnevenParts_BracketsWhatThenComesOut) {
  MemoryVolume& volume = uneven_volume();
  for (const Encoding encoding : {Encoding::float32, Encoding::automatic, Encoding::packed}) {
    const ConversionOptions asked = options(encoding, Budget::Kind::rate);
    const Forecast f = forecast(volume, asked, 14 * kMiB);
    const Sidecar made = convert(volume, asked);
    EXPECT_FALSE(f.whole);
    EXPECT_LE(f.sampled_voxels * sizeof(float), 14 * kMiB);
    EXPECT_GE(f.places, 256);
    EXPECT_EQ(f.parts, 8U);
    EXPECT_TRUE(f.exact_bytes);
    EXPECT_EQ(f.file_bytes.value, static_cast<double>(made.file.bytes));
    ASSERT_TRUE(f.error.psnr_db && made.error.psnr_db) << encoding_name(encoding);
    EXPECT_NEAR(f.error.psnr_db->value, *made.error.psnr_db, 1) << encoding_name(encoding);
    EXPECT_LE(f.error.psnr_db->low, *made.error.psnr_db) << encoding_name(encoding);
    EXPECT_GE(f.error.psnr_db->high, *made.error.psnr_db) << encoding_name(encoding);
  }
}

TEST_F(ForecastTest, SampleForAnErrorTarget_TellsTheSize) {
  MemoryVolume& volume = uneven_volume();
  const ConversionOptions asked = options(Encoding::automatic, Budget::Kind::psnr, 50);
  const Forecast f = forecast(volume, asked, 14 * kMiB);
  const auto bytes = static_cast<double>(convert(volume, asked).file.bytes);
  EXPECT_FALSE(f.exact_bytes);
  EXPECT_NEAR(f.file_bytes.value / bytes, 1, 0.05);
  EXPECT_LE(f.file_bytes.low, bytes);
  EXPECT_GE(f.file_bytes.high, bytes);
}

// A scene that shows values above 0.45, in the whole volume or only in its upper part.
SceneFile upper_values(bool region) {
  SceneFile file;
  file.path = "scene.toml";
  file.scene.mode = RenderMode::dvr;
  file.scene.volume.range = {0, 1};
  file.scene.volume.opacity = {{0, 0}, {0.45, 0}, {1, 1}};
  if (region) file.scene.volume.region = Box{{0, 0, 96}, {200, 256, 200}};
  return file;
}

TEST_F(ForecastTest, SampleWithAScene_TellsTheErrorOfWhatItShows) {
  MemoryVolume& volume = uneven_volume();
  for (const bool region : {false, true}) {
    for (const Encoding encoding : {Encoding::automatic, Encoding::packed}) {
      const std::string what = cat(encoding_name(encoding), region ? ", region" : "");
      ConversionOptions asked = options(encoding, Budget::Kind::rate);
      asked.scene = upper_values(region);
      if (encoding == Encoding::packed) asked.budget.rate = 40;
      const Forecast f = forecast(volume, asked, 14 * kMiB);
      const Sidecar made = convert(volume, asked);
      EXPECT_FALSE(f.whole);
      ASSERT_TRUE(f.shown && f.shown->psnr_db && made.visible->error.psnr_db) << what;
      EXPECT_NEAR(f.shown->psnr_db->value, *made.visible->error.psnr_db, 1.5) << what;
      EXPECT_LE(f.shown->psnr_db->low, *made.visible->error.psnr_db) << what;
      EXPECT_GE(f.shown->psnr_db->high, *made.visible->error.psnr_db) << what;
      ASSERT_TRUE(f.error.psnr_db) << what;
      EXPECT_NEAR(f.error.psnr_db->value, *made.error.psnr_db, 1) << what;
      const double share = static_cast<double>(f.shown_voxels) / static_cast<double>(f.sampled_voxels);
      EXPECT_NEAR(share, static_cast<double>(made.visible->voxels) / static_cast<double>(200 * 256 * 256), 0.02)
          << what;
    }
  }
}

TEST_F(ForecastTest, SampleOfChunksWithAScene_TellsTheErrorOfWhatItShows) {
  MemoryVolume volume({{0, 0, 0}, {192, 256, 256}}, uneven);
  volume.set_access({4, {32, 32, 32}, {}});
  ConversionOptions asked = options(Encoding::automatic, Budget::Kind::rate);
  asked.scene = upper_values(false);
  const Forecast f = forecast(volume, asked, 14 * kMiB);
  const Sidecar made = convert(volume, asked);
  ASSERT_TRUE(f.shown && f.shown->psnr_db);
  EXPECT_NEAR(f.shown->psnr_db->value, *made.visible->error.psnr_db, 1.5);
}

TEST_F(ForecastTest, SampleForAPsnrOfWhatASceneShows_TellsTheSize) {
  MemoryVolume& volume = uneven_volume();
  ConversionOptions asked = options(Encoding::packed, Budget::Kind::psnr, 50);
  asked.scene = upper_values(true);
  const Forecast f = forecast(volume, asked, 14 * kMiB);
  const auto bytes = static_cast<double>(convert(volume, asked).file.bytes);
  EXPECT_NEAR(f.file_bytes.value / bytes, 1, 0.1);
  EXPECT_LE(f.file_bytes.low, bytes);
  EXPECT_GE(f.file_bytes.high, bytes);
}

TEST_F(ForecastTest, SceneThatShowsNothing_HasNoErrorOfIt) {
  MemoryVolume& volume = uneven_volume();
  ConversionOptions asked = options(Encoding::packed, Budget::Kind::rate);
  asked.scene = upper_values(false);
  asked.scene->scene.volume.range = {10, 20};
  const Forecast f = forecast(volume, asked, 14 * kMiB);
  EXPECT_FALSE(f.shown);
  EXPECT_EQ(f.shown_voxels, 0U);
}

TEST_F(ForecastTest, SampleForALosslessFile_TellsTheSize) {
  MemoryVolume& volume = uneven_volume();
  const ConversionOptions asked = options(Encoding::automatic, Budget::Kind::lossless);
  const Forecast f = forecast(volume, asked, 14 * kMiB);
  EXPECT_TRUE(f.error.lossless);
  EXPECT_FALSE(f.error.psnr_db);
  EXPECT_NEAR(f.file_bytes.value / static_cast<double>(convert(volume, asked).file.bytes), 1, 0.01);
}

TEST_F(ForecastTest, ValuesThatAreRefused_AreReported) {
  MemoryVolume volume = volume_with_nan_in_every_block();
  const ConversionOptions asked = options(Encoding::automatic, Budget::Kind::rate);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { forecast(volume, asked, 8 * kMiB); }),
            "memory: 262144 of the 2097152 voxels sampled are NaN or infinite; choose --nonfinite background or "
            "--nonfinite keep");
  const std::string whole = message_of_error(ErrorKind::input, [&] { forecast(volume, asked, kForecastBytes); });
  EXPECT_EQ(whole, message_of_error(ErrorKind::input, [&] { convert(volume, asked); }));
}

TEST_F(ForecastTest, Errors_AreThoseOfTheConversion) {
  MemoryVolume volume({{0, 0, 0}, {64, 64, 64}}, uneven);
  ConversionOptions asked = options(Encoding::automatic, Budget::Kind::size);
  asked.budget.bytes = 10;
  EXPECT_EQ(message_of_error(ErrorKind::budget, [&] { forecast(volume, asked, kForecastBytes); }).substr(0, 20),
            (directory_ / "out.nvdb: 10 bytes asked").substr(0, 20));
  asked.budget.bytes = 1000000;
  asked.memory = kMiB;
  EXPECT_NE(message_of_error(ErrorKind::usage, [&] { forecast(volume, asked, 1000); })
                .find("--memory 1.0 MiB is too small for this volume with 2 threads; give at least "),
            std::string::npos);
  asked.memory = 4096 * kMiB;
  asked.output = directory_ / "missing/out.nvdb";
  EXPECT_EQ(message_of_error(ErrorKind::io, [&] { forecast(volume, asked, 1000); }),
            asked.output + ": the directory " + (directory_ / "missing") +
                " does not exist; make it or choose another output");
}

TEST_F(ForecastTest, SizeThatNoDiskHolds_IsRefusedByTheRoomThereIs) {
  ConversionOptions asked = options(Encoding::automatic, Budget::Kind::size);
  asked.budget.bytes = 1'000'000'000'000'000;
  for (const std::uint64_t most_bytes : {kForecastBytes, 14 * kMiB}) {  // the whole volume, and a sample
    const std::string message = message_of_error(ErrorKind::io, [&] { forecast(uneven_volume(), asked, most_bytes); });
    EXPECT_TRUE(message.starts_with(asked.output + ": takes 1000000000000000 bytes of ")) << message;
  }
}

TEST_F(ForecastTest, SizeAboveWhatAVolumeNeeds_IsExpectedWithItsNotice) {
  MemoryVolume volume({{0, 0, 0}, {64, 64, 64}}, noise);
  ConversionOptions asked = options(Encoding::automatic, Budget::Kind::size);
  asked.budget.bytes = 64 * kMiB;
  std::vector<std::string> notices;
  ConversionControl control;
  control.notice = [&](const Message& line) { notices.push_back(line.text()); };
  const Forecast f = forecast_conversion(volume, asked, control, *files_, kForecastBytes);
  EXPECT_EQ(f.file_bytes.value, static_cast<double>(asked.budget.bytes));
  EXPECT_TRUE(f.exact_bytes);
  EXPECT_TRUE(f.error.lossless);
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices.front().find(" of the 67108864 asked are padding, which --at-most leaves out"), std::string::npos)
      << notices.front();
}

TEST_F(ForecastTest, SampleForARate_NamesTheBudgetOfTheConversion) {
  MemoryVolume& volume = uneven_volume();
  ConversionOptions asked = options(Encoding::float32, Budget::Kind::rate);
  asked.budget.bytes = 8 * kMiB;
  EXPECT_EQ(forecast(volume, asked, 14 * kMiB).budget, "rate");
  asked.budget.kind = Budget::Kind::automatic;
  EXPECT_EQ(forecast(volume, asked, 14 * kMiB).budget, "rate");
  asked.budget.kind = Budget::Kind::size;
  EXPECT_EQ(forecast(volume, asked, 14 * kMiB).budget, "size");
}

TEST_F(ForecastTest, SmallestTreeAboveTheStandardRate_IsExpectedInstead) {
  MemoryVolume volume = volume_with_nan_in_every_block();
  ConversionOptions asked = options(Encoding::automatic, Budget::Kind::automatic);
  asked.non_finite = NonFinitePolicy::keep;
  const Forecast f = forecast(volume, asked, 8 * kMiB);
  const Sidecar made = convert(volume, asked);
  ASSERT_EQ(made.budget.kind, "minimum");
  EXPECT_EQ(f.budget, "minimum");
  EXPECT_EQ(f.not_sampled, "");
  EXPECT_FALSE(f.exact_bytes);
  EXPECT_NEAR(f.file_bytes.value / static_cast<double>(made.file.bytes), 1, 0.01);
}

TEST_F(ForecastTest, RateBelowTheSmallestTreeOfTheSampleAlone_IsRefused) {
  MemoryVolume volume = volume_with_nan_in_every_block();
  ConversionOptions asked = options(Encoding::automatic, Budget::Kind::rate);
  asked.non_finite = NonFinitePolicy::keep;
  for (const bool at_most : {false, true}) {
    asked.budget.at_most = at_most;
    const std::string message = message_of_error(ErrorKind::budget, [&] { forecast(volume, asked, 8 * kMiB); });
    EXPECT_TRUE(
        message.starts_with(asked.output + ": 4194304 bytes asked, the smallest tree for this volume takes about 3"))
        << message;
  }
}

TEST_F(ForecastTest, RateBelowTheSmallestTreeAsASampleHasIt_IsReported) {
  MemoryVolume volume = volume_with_nan_in_every_block();
  ConversionOptions asked = options(Encoding::automatic, Budget::Kind::rate);
  asked.non_finite = NonFinitePolicy::keep;
  asked.budget.rate = 2;
  const Forecast f = forecast(volume, asked, 8 * kMiB);
  EXPECT_TRUE(f.not_sampled.starts_with("by one, the smallest tree for this volume takes about 3")) << f.not_sampled;
}

TEST_F(ForecastTest, RangeOfOneBusyPlace_HasNoSizeBelowZero) {
  const Box domain{{0, 0, 0}, {200, 256, 256}};
  const SamplePlan plan(domain, AccessShape{}, static_cast<std::int64_t>(14 * kMiB / sizeof(float)), 1);
  const Index3 corner = plan.source_corner({0, 0, 0});
  const Box busy{corner, corner + plan.cell()};
  MemoryVolume volume(domain, [&](const Index3& i) {
    return busy.contains(Box{i, i + Index3{1, 1, 1}}) ? noise(i) : 0;
  });
  const Forecast f = forecast(volume, options(Encoding::packed, Budget::Kind::lossless), 14 * kMiB);
  EXPECT_GT(f.file_bytes.high, 2 * f.file_bytes.value);
  EXPECT_EQ(f.file_bytes.low, 0);
}

TEST_F(ForecastTest, SizeBelowAnyFile_IsRefusedBySampleToo) {
  MemoryVolume volume({{0, 0, 0}, {128, 256, 256}}, uneven);
  ConversionOptions asked = options(Encoding::automatic, Budget::Kind::size);
  asked.budget.bytes = 10;
  EXPECT_NE(message_of_error(ErrorKind::budget, [&] { forecast(volume, asked, 8 * kMiB); })
                .find("out.nvdb: 10 bytes asked, a file of this volume takes "),
            std::string::npos);
}

TEST_F(ForecastTest, LargeChunks_AreNotSampled) {
  MemoryVolume volume({{0, 0, 0}, {128, 128, 256}}, uneven);
  volume.set_access({4, {128, 128, 128}, {}});
  const Forecast f = forecast(volume, options(Encoding::automatic, Budget::Kind::rate), kMiB);
  EXPECT_EQ(f.not_sampled, "its chunks are too large for a sample");
  EXPECT_EQ(f.file_bytes.value, 128.0 * 128 * 256 * 4 / 8);
  EXPECT_TRUE(f.exact_bytes);
}

TEST_F(ForecastTest, FullDisk_IsReported) {
  MemoryVolume volume({{0, 0, 0}, {64, 64, 64}}, uneven);
  ConversionOptions asked = options(Encoding::float32, Budget::Kind::size);
  asked.budget.bytes = 600000;
  asked.resume = Resume::on;  // the records lie on the disk
  FaultyFileSystem disk(*files_, -1, 0);
  disk.leave_free(600000);
  const std::string message =
      message_of_error(ErrorKind::io, [&] { forecast_conversion(volume, asked, {}, disk, kForecastBytes); });
  EXPECT_TRUE(message.starts_with(asked.output + ": takes 702400")) << message;
  EXPECT_TRUE(message.ends_with(" bytes of " + directory_.path().string() +
                                ", which has 600000 free; free space on that file system or choose another with -o or "
                                "--work-dir"))
      << message;
}

}  // namespace
}  // namespace weir::forecast_test
