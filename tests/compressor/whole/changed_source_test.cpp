// Sources that are rewritten while they are converted. Whenever it happens, the conversion ends with an error that
// names the file, and leaves nothing behind.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "format/base/error.h"
#include "format/process/process_memory.h"
#include "ingest/source/source_view.h"
#include "ingest/source_registry.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/resumed.h"
#include "tests/support/temporary_directory.h"

namespace weir::changed_source_test {
namespace {

namespace fs = std::filesystem;
using test::CrashFileSystem;
using test::Names;

constexpr Index3 kExtent{64, 64, 40};

std::vector<float> values_of(int seed, std::int64_t count) {
  std::vector<float> values(static_cast<std::size_t>(count));
  auto state = static_cast<std::uint32_t>(seed);
  for (float& v : values) v = static_cast<float>((state = state * 1664525U + 1013904223U) >> 8U);
  return values;
}

// Writes in place, so that the inode stays.
void write(const std::string& path, const std::vector<float>& values, std::int64_t first = 0) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  if (!file) file.open(path, std::ios::binary | std::ios::out);
  file.seekp(first * static_cast<std::int64_t>(sizeof(float)));
  file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
}

// Waits until the clock of the file system has moved on since `path` was written.
void wait_for_a_tick(const std::string& path) {
  const std::string probe = path + ".probe";
  do {
    std::ofstream(probe) << "probe";
  } while (look_at_file(probe).ctime_ns <= look_at_file(path).ctime_ns);
  fs::remove(probe);
}

// Before each read, calls `at` with the number of earlier reads.
class HookedSource final : public VolumeSource {
 public:
  HookedSource(std::unique_ptr<VolumeSource> source, std::function<void(int)> at)
      : source_(std::move(source)), info_(source_->info()), at_(std::move(at)) {}

  const SourceInfo& info() const override { return info_; }
  /// Removes the list of files, so that only the values can tell that the source changed.
  void forget_files() { info_.files.clear(); }
  AccessShape access() const override { return {4, {64, 64, 8}, {0, 0, 0}}; }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    const std::lock_guard lock(mutex_);
    at_(reads_++);
    return source_->read(box, values);
  }
  std::uint64_t bytes_read() const override { return source_->bytes_read(); }
  int reads() const { return reads_; }

 private:
  std::unique_ptr<VolumeSource> source_;
  SourceInfo info_;
  std::function<void(int)> at_;
  std::mutex mutex_;
  int reads_ = 0;
};

class ChangedSourceTest : public testing::Test {
 protected:
  ChangedSourceTest() { write(path_, values_of(1, volume(kExtent))); }

  SourceOptions shape() const {
    SourceOptions options;
    options.extent = kExtent;
    options.type = ScalarType::float32;
    options.direct_io = DirectIo::off;
    return options;
  }

  // Returns the error message; empty if the conversion succeeded. Sets `pass` to the pass that began last.
  std::string convert(VolumeSource& source, std::string* pass = nullptr, const std::function<void()>& at_encode = {}) {
    CrashFileSystem files;
    ConversionOptions options;
    options.output = "out.nvdb";
    options.budget.kind = Budget::Kind::lossless;
    options.threads = 2;
    options.memory = resident_bytes() + (std::uint64_t{60} << 20U);  // no values stay between the passes
    ConversionControl control;
    control.pass_started = [&](const std::string& name, std::uint64_t) {
      if (pass != nullptr) *pass = name;
      if (name == "encode" && at_encode) at_encode();
    };
    try {
      convert_volume(source, options, control, files);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
      EXPECT_EQ(files.names(), Names{});
      return error.what();
    }
    EXPECT_EQ(files.names(), test::kResult);
    return {};
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "a.raw";
};

TEST_F(ChangedSourceTest, UntouchedSource_Converts) {
  HookedSource source(open_source(path_, shape()), [](int) {});
  EXPECT_EQ(convert(source), "");
  EXPECT_GE(source.reads(), 2) << "a survey and an encode pass";
}

TEST_F(ChangedSourceTest, RewrittenBeforeAnyRead_EndsWithExit3AndNamesTheFile) {
  int reads = 1;
  for (int at = 0; at < reads; ++at) {
    write(path_, values_of(1, volume(kExtent)));
    wait_for_a_tick(path_);
    HookedSource source(open_source(path_, shape()), [&](int read) {
      if (read == at) write(path_, values_of(2, volume(kExtent)));
    });
    const std::string message = convert(source);
    EXPECT_TRUE(message.starts_with(path_ + ": changed while it was read: it was written to at ")) << message;
    EXPECT_TRUE(message.ends_with("; convert it again once nothing writes to it")) << message;
    if (at == 0) {
      HookedSource undisturbed(open_source(path_, shape()), [](int) {});
      convert(undisturbed);
      reads = undisturbed.reads();
    }
  }
}

TEST_F(ChangedSourceTest, OneValueRewrittenBetweenThePasses_IsFoundByTheValuesAlone) {
  HookedSource source(open_source(path_, shape()), [](int) {});
  source.forget_files();
  const std::int64_t voxel = linear_index({40, 20, 33}, kExtent);
  EXPECT_EQ(convert(source, nullptr, [&] { write(path_, {-1.0F}, voxel); }),
            path_ +
                ": changed while it was read: voxels 40:48,16:24,32:40 have other values than a moment ago; "
                "convert it again once nothing writes to it");
}

TEST_F(ChangedSourceTest, AppendedTo_EndsWithExit3) {
  HookedSource source(open_source(path_, shape()), [&](int read) {
    if (read == 0) write(path_, {1.0F}, volume(kExtent));
  });
  std::string pass;
  EXPECT_EQ(convert(source, &pass), path_ +
                                        ": changed while it was read: it had 655360 bytes and has 655364; convert "
                                        "it again once nothing writes to it");
  EXPECT_EQ(pass, "survey") << "no encode pass is spent on it";
}

TEST_F(ChangedSourceTest, CutWhileItIsRead_IsReportedAsAChange) {
  HookedSource source(open_source(path_, shape()), [&](int read) {
    if (read == 0) fs::resize_file(path_, 100);
  });
  EXPECT_EQ(convert(source), path_ +
                                 ": changed while it was read: it had 655360 bytes and has 100; convert it again "
                                 "once nothing writes to it");
}

TEST_F(ChangedSourceTest, ReplacedByARename_EndsWithExit3) {
  HookedSource source(open_source(path_, shape()), [](int) {});
  EXPECT_EQ(convert(source, nullptr,
                    [&] {
                      write(directory_ / "b", values_of(2, volume(kExtent)));
                      fs::last_write_time(directory_ / "b", fs::last_write_time(path_));
                      fs::rename(directory_ / "b", path_);
                    }),
            path_ +
                ": changed while it was read: another file has taken its place; convert it again once nothing "
                "writes to it");
}

TEST_F(ChangedSourceTest, PlaneOfAStackRewritten_IsNamed) {
  SourceOptions plane = shape();
  plane.extent = Index3{32, 32, 1};
  plane.stack = true;
  for (int z = 0; z < 20; ++z) {
    write(directory_ / ("p" + std::to_string(100 + z) + ".bin"), values_of(z, std::int64_t{32} * 32));
  }
  const std::string rewritten = directory_ / "p107.bin";
  wait_for_a_tick(rewritten);
  const auto source = open_source(directory_ / "p%03d.bin", plane);
  ASSERT_EQ(source->info().files.size(), 20U);
  const std::string message =
      convert(*source, nullptr, [&] { write(rewritten, values_of(99, std::int64_t{32} * 32)); });
  EXPECT_TRUE(message.starts_with(rewritten + ": changed while it was read: it was written to at ")) << message;
}

TEST_F(ChangedSourceTest, DetachedDataRewritten_IsNamed) {
  const std::string header = directory_ / "a.nhdr";
  std::ofstream(header) << "NRRD0004\ntype: float\ndimension: 3\nsizes: 64 64 40\nendian: little\nencoding: raw\n"
                           "data file: a.raw\n";
  wait_for_a_tick(path_);
  const auto source = open_source(header, {});
  const std::string message = convert(*source, nullptr, [&] { write(path_, values_of(2, volume(kExtent))); });
  EXPECT_TRUE(message.starts_with(path_ + ": changed while it was read: it was written to at ")) << message;
}

// cp -p and rsync -t keep the size and the modification time.
TEST_F(ChangedSourceTest, ResumeOfAnotherFileOfTheSameSizeAndTime_BeginsAnew) {
  const auto run = [&](FileSystem& files, bool interrupt) {
    const auto source = open_source(path_, shape());
    std::atomic<bool> cancel{false};
    ConversionOptions options;
    options.output = "out.nvdb";
    options.budget.kind = Budget::Kind::lossless;
    options.resume = Resume::on;
    options.save_interval_s = 0;
    options.threads = 1;
    options.memory = resident_bytes() + (std::uint64_t{60} << 20U);  // no values stay between the passes
    ConversionControl control;
    control.cancel = &cancel;
    control.pass_started = [&](const std::string& pass, std::uint64_t) { cancel = interrupt && pass == "encode"; };
    Names notices;
    control.notice = [&](const Message& line) { notices.push_back(line.text()); };
    std::string digest;
    try {
      digest = convert_volume(*source, options, control, files).source.digest;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::interrupted) << error.what();
    }
    return std::pair(digest, notices);
  };
  CrashFileSystem files;
  EXPECT_EQ(run(files, true).first, "");
  const auto time = fs::last_write_time(path_);
  write(directory_ / "b", values_of(2, volume(kExtent)));
  fs::last_write_time(directory_ / "b", time);
  fs::rename(directory_ / "b", path_);
  const auto [digest, notices] = run(files, false);
  CrashFileSystem undisturbed;
  EXPECT_EQ(digest, run(undisturbed, false).first);
  EXPECT_TRUE(files.content("out.nvdb") == undisturbed.content("out.nvdb"));
  for (const std::string& notice : notices) EXPECT_EQ(notice.find("continues"), std::string::npos) << notice;
}

}  // namespace
}  // namespace weir::changed_source_test
