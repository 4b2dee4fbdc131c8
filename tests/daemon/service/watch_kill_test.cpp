// Tests kill -9 at random moments during a batch: in the end all results are there and correct, and nothing else is.
// WEIR_KILLS sets the number of kills in the test with writers.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <thread>
#include <utility>

#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "tests/daemon/support/service_harness.h"

namespace weir::watch_kill_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using Names = std::vector<std::string>;

constexpr int kKills = 50;
constexpr int kFiles = 40;

int number_from(const char* variable, int otherwise) {
  const char* const given = std::getenv(variable);
  return given == nullptr ? otherwise : std::stoi(given);
}

TEST(WatchKill, FiftyKillsLoseNothingAndRedoNothing) {
  ServiceHarness service("jobs = 2\nwork_dir = \"work\"\n", "thumbnails = true\nsettle = 0.05\n");
  fs::create_directory(service.path("work"));
  // Some conversions take longer, so that kills hit them in all stages.
  std::string big(std::size_t{192} * 192 * 192, '\0');
  std::minstd_rand noise;
  for (char& value : big) value = static_cast<char>(noise() >> 20U);
  for (int i = 0; i < kFiles; ++i) {
    if (i % 4 == 0) {
      write_file(service.in(cat("big", i, "_192x192x192_uint8.raw")), big);
    } else {
      service.add(cat("small", i), i + 1);
    }
  }
  std::minstd_rand random(std::random_device{}());
  std::map<std::string, fs::file_time_type> finished;
  for (int kill = 0; kill < kKills; ++kill) {
    service.launch();
    std::this_thread::sleep_for(milliseconds(20 + random() % 280));
    service.kill();
    for (const auto& entry : fs::directory_iterator(service.out())) {
      const std::string name = entry.path().filename().string();
      if (!name.ends_with(".nvdb")) continue;
      // A name always stands for a whole file, and a whole file is not made again.
      const auto [known, is_new] = finished.emplace(name, entry.last_write_time());
      EXPECT_EQ(known->second, entry.last_write_time()) << name << " was converted again after kill " << kill;
      if (is_new) {
        EXPECT_EQ(run_weir({"verify", entry.path().string(), "--progress", "never"}).exit_code, 0) << name;
      }
    }
  }
  service.start();
  ASSERT_TRUE(service.eventually_done(kFiles, std::chrono::seconds(90))) << service.get("/api/status");
  const auto jobs = service.get("/api/jobs?limit=1000");
  for (const auto& job : jobs["jobs"]) EXPECT_EQ(job["attempts"], 0) << job;
  for (const auto& [name, time] : finished) EXPECT_EQ(fs::last_write_time(service.out(name)), time) << name;
  EXPECT_EQ(service.stop(), 0);
  EXPECT_EQ(service.leftovers(), Names{});
  EXPECT_EQ(list_directory(service.path("work")), Names{});
  EXPECT_EQ(list_directory(service.out()).size(), 3U * kFiles);
  for (int i = 0; i < kFiles; i += i < 8 ? 1 : 7) {
    const std::string name =
        i % 4 == 0 ? cat("big", i, "_192x192x192_uint8") : cat("small", i, ServiceHarness::kSuffix);
    EXPECT_EQ(service.difference(name + ".raw", name + ".nvdb"), "");
  }
}

// Writers that write files of several formats slowly, while the service is killed and deletes verified sources.
class PausingWriter {
 public:
  PausingWriter(const ServiceHarness& service, int files) : service_(service), files_(files) {}

  void run() {
    for (int i = 0; i < files_; ++i) write(i);
  }
  /// The final content of each file.
  const std::map<std::string, std::string>& written() const { return written_; }

 private:
  static std::string values(int seed, std::size_t count) {
    std::minstd_rand random(static_cast<unsigned>(seed) + 1);
    std::string bytes(count, '\0');
    for (char& value : bytes) value = static_cast<char>(random() >> 24U);
    return bytes;
  }
  static std::pair<std::string, std::string> source(int i) {
    const std::string bytes = values(i, 48 * 40 * 32);
    switch (i % 3) {
      case 0:
        return {cat("raw", i, "_48x40x32_uint8.raw"), bytes};
      case 1:
        return {cat("nrrd", i, ".nrrd"),
                cat("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 48 40 32\nencoding: raw\n\n", bytes)};
      default:
        return {cat("meta", i, ".mha"),
                cat("ObjectType = Image\nNDims = 3\nDimSize = 48 40 32\nElementType = MET_UCHAR\n"
                    "ElementDataFile = LOCAL\n",
                    bytes)};
    }
  }
  static void pause() { std::this_thread::sleep_for(milliseconds(150)); }
  static void put(const Descriptor& file, const std::string& bytes, std::size_t from, std::size_t end) {
    ASSERT_EQ(::pwrite(file.get(), bytes.data() + from, end - from, static_cast<off_t>(from)),
              static_cast<ssize_t>(end - from));
  }

  void write(int i) {
    const auto [name, bytes] = source(i);
    const std::string path = service_.in(name);
    std::optional<Descriptor> file(std::in_place, ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
    ASSERT_GE(file->get(), 0);
    switch (i % 4) {
      case 0:  // in one write
        put(*file, bytes, 0, bytes.size());
        break;
      case 1:  // with a pause in the middle
        put(*file, bytes, 0, bytes.size() / 2);
        pause();
        put(*file, bytes, bytes.size() / 2, bytes.size());
        break;
      case 2:  // with its full size at once and its values later
        put(*file, bytes, 0, 200);
        ASSERT_EQ(::ftruncate(file->get(), static_cast<off_t>(bytes.size())), 0);
        pause();
        pause();
        put(*file, bytes, 200, bytes.size());
        break;
      default: {  // through two descriptors; one is closed when the file has its full size
        const Descriptor other(::open(path.c_str(), O_RDWR | O_CLOEXEC));
        std::string first = bytes;
        first.back() = static_cast<char>(first.back() + 1);
        put(*file, first, 0, first.size());
        file.reset();
        pause();
        pause();
        put(other, bytes, bytes.size() - 1, bytes.size());
        break;
      }
    }
    written_.emplace(name, bytes);
  }

  const ServiceHarness& service_;
  int files_;
  std::map<std::string, std::string> written_;
};

TEST(WatchKill, WithPausingWritersAndDeletions_LosesNothing) {
  const int kills = number_from("WEIR_KILLS", 40);
  ServiceHarness service("jobs = 2\n",
                         "settle = 0.05\nsource = \"delete-after-verify\"\ndelete_after = 0.2\n"
                         "include = [\"*.raw\", \"*.nrrd\", \"*.mha\"]\n");
  PausingWriter writer(service, kills);
  std::thread writing([&] { writer.run(); });
  std::minstd_rand random(std::random_device{}());
  for (int kill = 0; kill < kills; ++kill) {
    service.launch();
    std::this_thread::sleep_for(milliseconds(20 + random() % 480));
    service.kill();
  }
  writing.join();
  service.start();
  const bool all_gone = ServiceHarness::eventually([&] { return list_directory(service.in()).empty(); },
                                                   std::chrono::seconds(30 + kills));
  EXPECT_TRUE(all_gone) << testing::PrintToString(list_directory(service.in())) << service.get("/api/jobs?limit=1000");
  EXPECT_EQ(service.stop(), 0);
  EXPECT_EQ(service.leftovers(), Names{});
  EXPECT_EQ(writer.written().size(), static_cast<std::size_t>(kills));
  for (const auto& [name, bytes] : writer.written()) {
    write_file(service.in(name), bytes);
    EXPECT_EQ(service.difference(name, fs::path(name).stem().string() + ".nvdb"), "") << name;
  }
}

}  // namespace
}  // namespace weir::watch_kill_test
