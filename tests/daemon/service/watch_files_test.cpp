// Tests how files arrive in a watched directory, with the real `weir watch`. Each is converted exactly once, to the
// bytes of a plain `weir convert`, and never half-read. Runs with inotify and polling disabled, and with polling and
// inotify disabled.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "tests/daemon/support/service_harness.h"

namespace weir::watch_files_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using Names = std::vector<std::string>;

/// watch = "inotify" (which polls nothing) and watch = "poll" (which opens no inotify).
class WatchFiles : public testing::TestWithParam<const char*> {
 protected:
  static std::string keys(const std::string& more = "") { return cat("watch = \"", GetParam(), "\"\n", more); }
};

INSTANTIATE_TEST_SUITE_P(, WatchFiles, testing::Values("inotify", "poll"),
                         [](const auto& method) { return std::string(method.param); });

TEST_P(WatchFiles, ExistingAndNewFilesAreConvertedOnce) {
  ServiceHarness service("", keys());
  const std::string before = service.add("before", 3);
  service.start();
  const std::string after = service.add("after", 5);
  ASSERT_TRUE(service.eventually_done(2)) << service.log();
  EXPECT_EQ(service.difference(before + ".raw", before + ".nvdb"), "");
  EXPECT_EQ(service.difference(after + ".raw", after + ".nvdb"), "");
  EXPECT_EQ(service.get("/api/status")["watches"][0]["method"], GetParam());
  EXPECT_EQ(service.stop(), 0);
  EXPECT_EQ(service.logged(" start "), 2U);
  EXPECT_EQ(service.leftovers(), Names{});
}

TEST_P(WatchFiles, ASlowWriterIsWaitedFor) {
  ServiceHarness service("", keys("settle = 2\n"));
  service.start();
  const std::string volume = ServiceHarness::volume(3);
  const std::string name = std::string("slow") + ServiceHarness::kSuffix;
  {
    std::ofstream file(service.in(name + ".raw"), std::ios::binary);
    for (std::size_t at = 0; at < volume.size(); at += 320) {
      file.write(volume.data() + at, 320).flush();
      std::this_thread::sleep_for(milliseconds(150));
      ASSERT_EQ(service.logged(" start "), 0U) << "at byte " << at;
    }
  }
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.difference(name + ".raw", name + ".nvdb"), "");
  EXPECT_EQ(service.logged(" start "), 1U);
}

TEST_P(WatchFiles, FileRenamedIntoPlace_IsConvertedOnce) {
  ServiceHarness service("", keys());
  service.start();
  const std::string name = std::string("moved") + ServiceHarness::kSuffix;
  write_file(service.in(name + ".raw.tmp"), ServiceHarness::volume(7));
  fs::rename(service.in(name + ".raw.tmp"), service.in(name + ".raw"));
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.difference(name + ".raw", name + ".nvdb"), "");
  EXPECT_EQ(service.logged(" start "), 1U);
}

TEST_P(WatchFiles, FilesAddedWhileStopped_AreConvertedAfterTheStart) {
  ServiceHarness service("", keys());
  service.start();
  const std::string first = service.add("first");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.stop(), 0);
  const std::string second = service.add("second", 5);
  service.start();
  ASSERT_TRUE(service.eventually_done(2)) << service.log();
  EXPECT_EQ(service.difference(second + ".raw", second + ".nvdb"), "");
  EXPECT_EQ(service.logged(" start "), 2U) << "the first one is known";
}

TEST_P(WatchFiles, NestedDirectoriesAreRepeatedInTheOutput) {
  ServiceHarness service("", keys("recursive = true\n"));
  fs::create_directories(service.in("old/er"));
  const std::string a = service.add("old/er/a");
  service.start();
  fs::create_directories(service.in("new/deep/er"));
  const std::string b = service.add("new/deep/er/b", 5);
  const std::string c = service.add("new/c", 7);
  ASSERT_TRUE(service.eventually_done(3)) << service.log();
  for (const std::string& name : {a, b, c}) EXPECT_EQ(service.difference(name + ".raw", name + ".nvdb"), "");
  EXPECT_EQ(service.leftovers(), Names{});
}

TEST_P(WatchFiles, SourceReplacedDuringConversion_IsConvertedAgain) {
  ServiceHarness service("", keys());
  const std::string source = service.in("big_256x256x256_uint8.raw");
  write_file(source, std::string(256 << 16, 'a'));
  service.start();
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" start ") == 1; })) << service.log();
  std::string newer(256 << 16, 'b');
  newer[12345] = 'c';
  write_file(service.in("big.tmp"), newer);
  fs::rename(service.in("big.tmp"), source);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" start ") == 2; })) << service.log();
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.difference("big_256x256x256_uint8.raw", "big_256x256x256_uint8.nvdb"), "");
  EXPECT_EQ(service.job("big_256x256x256_uint8.raw")["attempts"], 0);
  EXPECT_EQ(service.leftovers(), Names{});
}

TEST_P(WatchFiles, ATruncatedFileIsQuarantinedAndTriedAgainWhenItChanges) {
  ServiceHarness service("", keys());
  service.start();
  const std::string name = std::string("short") + ServiceHarness::kSuffix;
  write_file(service.in(name + ".raw"), ServiceHarness::volume(3).substr(1000));
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("quarantined") == 1; })) << service.log();
  const auto job = service.job(name + ".raw");
  EXPECT_NE(job["reason"].get<std::string>().find("6680"), std::string::npos) << job;
  write_file(service.in(name + ".raw"), ServiceHarness::volume(3));
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.difference(name + ".raw", name + ".nvdb"), "");
}

TEST_P(WatchFiles, DirectoryMadeLateOrReplaced_IsWatched) {
  ServiceHarness service("", keys());
  fs::remove(service.in());
  service.start();
  EXPECT_FALSE(service.get("/api/status")["watches"][0]["up"].get<bool>());
  fs::create_directory(service.in());
  service.add("one");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  fs::rename(service.in(), service.path("away"));
  fs::create_directory(service.in());
  const std::string two = service.add("two", 5);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.job(two + ".raw")["state"] == "done"; }))
      << service.log();
}

TEST_P(WatchFiles, ALinkOutOfTheTreeIsRefused) {
  ServiceHarness service("", keys());
  write_file(service.path(std::string("secret") + ServiceHarness::kSuffix + ".raw"), ServiceHarness::volume(3));
  fs::create_symlink(service.path(std::string("secret") + ServiceHarness::kSuffix + ".raw"),
                     service.in(std::string("link") + ServiceHarness::kSuffix + ".raw"));
  service.start();
  const std::string name = service.add("fine");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.get("/api/jobs")["total"], 1);
  EXPECT_EQ(service.job(name + ".raw")["state"], "done");
}

TEST_P(WatchFiles, HeaderNamingAFileOutside_NeedsFollowAnywhere) {
  ServiceHarness service("", keys());
  write_file(service.path("secret.raw"), ServiceHarness::volume(3));
  write_file(service.in("a.mhd"),
             "ObjectType = Image\nNDims = 3\nDimSize = 24 20 16\nElementType = MET_UCHAR\n"
             "ElementDataFile = ../secret.raw\n");
  service.start();
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("quarantined") == 1; })) << service.log();
  const std::string reason = service.job("a.mhd")["reason"];
  EXPECT_TRUE(reason.starts_with(service.in("a.mhd") + ": lies in ") &&
              reason.ends_with("/secret.raw, outside " + service.path("in") +
                               "; move it there, or convert it without --within, in a watch with follow = "
                               "\"anywhere\""))
      << reason;
  EXPECT_FALSE(std::filesystem::exists(service.out("a.nvdb")));
  service.stop();

  service.configure("", keys("follow = \"anywhere\"\n"));
  service.start();
  EXPECT_EQ(service.post("/api/jobs/" + std::to_string(service.job("a.mhd")["id"].get<int>()) + "/retry").is_null(),
            false);
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
}

// On a file system with times in whole seconds, the rewritten file has the same size, time and inode.
TEST(WatchRacyTimes, RewriteWithTheSameSizeAndTime_IsConverted) {
  ServiceHarness service("", "watch = \"inotify\"\nsettle = 0.2\n");
  service.start();
  const timespec second{std::time(nullptr), 0};
  const auto write_in_place = [&](int seed) {
    const std::string path = service.in(std::string("a") + ServiceHarness::kSuffix + ".raw");
    const Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644));
    const std::string bytes = ServiceHarness::volume(seed);
    EXPECT_EQ(::write(file.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    const timespec times[2]{second, second};
    EXPECT_EQ(::futimens(file.get(), times), 0);
  };
  write_in_place(3);
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  write_in_place(5);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" done job=1 ") == 2; })) << service.log();
  const std::string stem = std::string("a") + ServiceHarness::kSuffix;
  EXPECT_EQ(service.difference(stem + ".raw", stem + ".nvdb"), "");
}

TEST_P(WatchFiles, SourceIsConvertedOnlyAfterItsMarkerAppears) {
  ServiceHarness service("", keys("complete = \"marker\"\nsource = \"delete-after-verify\"\ndelete_after = 0.2\n"));
  service.start();
  const std::string name = service.add("marked");
  const std::string plain = service.path("plain.nvdb");
  ASSERT_EQ(run_weir({"convert", service.in(name + ".raw"), "-o", plain, "--threads", "1"}).exit_code, 0);
  std::this_thread::sleep_for(milliseconds(700));
  EXPECT_EQ(service.logged(" start "), 0U);
  write_file(service.in(name + ".raw.done"), "");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(read_file(service.out(name + ".nvdb")), read_file(plain));
  EXPECT_TRUE(ServiceHarness::eventually([&] { return list_directory(service.in()).empty(); }))
      << "the source and its marker are deleted";
}

// Returns a text file of VTK with 4^3 values of each array.
std::string vtk_file(const std::vector<std::string>& arrays) {
  std::string text =
      "# vtk DataFile Version 3.0\nfields\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 4 4 4\nORIGIN 0 0 0\n"
      "SPACING 1 1 1\nPOINT_DATA 64\n";
  for (const std::string& name : arrays) {
    text += cat("SCALARS ", name, " float 1\nLOOKUP_TABLE default\n");
    for (int i = 0; i < 64; ++i) text += cat(i, i % 16 == 15 ? "\n" : " ");
  }
  return text;
}

TEST(WatchDeletion, AFileWithAnotherFieldStays) {
  ServiceHarness service(
      "", "settle = 0.05\ndataset = \"density\"\nsource = \"delete-after-verify\"\ndelete_after = 0.2\n");
  service.start();
  write_file(service.in("one.vtk"), vtk_file({"density"}));
  write_file(service.in("two.vtk"), vtk_file({"density", "pressure"}));
  ASSERT_TRUE(service.eventually_done(2)) << service.log();
  EXPECT_TRUE(ServiceHarness::eventually([&] { return service.logged(" not-deleted ") == 1; })) << service.log();
  EXPECT_EQ(service.logged("its outputs have 64 of the 128 values in it, "), 1U) << service.log();
  EXPECT_TRUE(ServiceHarness::eventually([&] { return !fs::exists(service.in("one.vtk")); })) << service.log();
  EXPECT_TRUE(fs::exists(service.in("two.vtk")));
}

/// Makes the machine-wide limit on queued inotify events small while the object lives. This is only for a moment: a
/// queue keeps the limit of its creation, and a test that is killed in between leaves the limit small.
class SmallQueue {
 public:
  SmallQueue() : before_(read_file(kPath)) { std::ofstream(kPath) << 16; }
  ~SmallQueue() { std::ofstream(kPath) << before_; }
  SmallQueue(const SmallQueue&) = delete;
  SmallQueue& operator=(const SmallQueue&) = delete;
  bool works() const { return read_file(kPath) == "16\n"; }

 private:
  static constexpr const char* kPath = "/proc/sys/fs/inotify/max_queued_events";
  std::string before_;
};

// WEIR_MANY_FILES sets the number of files; each conversion runs three processes.
TEST(WatchManyFiles, ManyAtOnceThroughASmallQueue) {
  auto small = std::make_unique<SmallQueue>();
  if (!small->works()) GTEST_SKIP() << "fs.inotify.max_queued_events cannot be set here";
  ServiceHarness service("jobs = 2\nmemory = \"1GiB\"\n", "watch = \"inotify\"\n");
  service.start();
  small.reset();
  const char* const asked = std::getenv("WEIR_MANY_FILES");
  const int files = asked == nullptr ? 300 : std::stoi(asked);
  const std::string volume = ServiceHarness::volume(3).substr(0, 8 * 8 * 8);
  for (int i = 0; i < files; ++i) write_file(service.in(cat("f", i, "_8x8x8_uint8.raw")), volume);
  ASSERT_TRUE(service.eventually_done(static_cast<std::uint64_t>(files), std::chrono::seconds(900)))
      << service.get("/api/status");
  EXPECT_GT(service.get("/api/status")["watches"][0]["overflows"], 0);
  EXPECT_EQ(service.logged(" start "), static_cast<std::size_t>(files));
  EXPECT_EQ(service.difference("f234_8x8x8_uint8.raw", "f234_8x8x8_uint8.nvdb"), "");
  const std::string expected = read_file(service.out("f234_8x8x8_uint8.nvdb"));
  for (int i = 0; i < files; ++i) {
    ASSERT_EQ(read_file(service.out(cat("f", i, "_8x8x8_uint8.nvdb"))), expected) << i;
  }
  EXPECT_EQ(list_directory(service.out()).size(), 2 * static_cast<std::size_t>(files));
}

TEST_P(WatchFiles, NameThatIsNotUtf8_IsQuarantinedWithItsEvent) {
  ServiceHarness service("", keys());
  service.start();
  write_file(service.in("a\xff_24x20x16_uint8.raw"), ServiceHarness::volume(1));
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" warning quarantined ") == 1; }))
      << service.log();
  EXPECT_EQ(service.logged("reason=\"the name is not UTF-8; rename the file\""), 1U) << service.log();
  EXPECT_EQ(service.count("quarantined"), 1U);
}

// Only with inotify: polling does not see how a file arrived.
TEST(WatchFilesByRename, FileThatIsCreatedAndSet_WaitsForItsRename) {
  ServiceHarness service("", "watch = \"inotify\"\ncomplete = \"rename\"\n");
  service.add("first");
  service.start();
  ASSERT_TRUE(service.eventually_done(1)) << "else the file may be found, not seen as it is made: " << service.log();
  const std::string name = "open_24x20x16_uint8.raw";
  const Descriptor file(::open(service.in(name).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644));
  ASSERT_EQ(::ftruncate(file.get(), 24 * 20 * 16), 0);
  const auto reason = [&] { return service.job(name).value("reason", ""); };
  EXPECT_TRUE(ServiceHarness::eventually([&] { return reason() == "it has not got its name by a rename"; }))
      << service.log();
  std::this_thread::sleep_for(milliseconds(600));  // twice the settle time
  EXPECT_EQ(service.count("discovered"), 1U) << service.log();
  fs::rename(service.in(name), service.in("." + name));
  fs::rename(service.in("." + name), service.in(name));
  EXPECT_TRUE(service.eventually_done(2)) << service.log();
}

}  // namespace
}  // namespace weir::watch_files_test
