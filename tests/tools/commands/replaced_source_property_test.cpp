// Tests that a certificate belongs to the volume that it names, over random kills and over sources that are replaced
// between runs and during a run, with equal sizes and times. WEIR_PROPERTY_VOLUMES sets the number of runs.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "format/base/text.h"
#include "tests/support/run_command.h"

namespace weir::replaced_source_property_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kVoxels = std::size_t{96} * 96 * 96;

class ReplacedSourceProperty : public ::testing::Test {
 protected:
  ReplacedSourceProperty() {
    fs::create_directory(directory_ / "out");
    for (int seed = 0; seed < 4; ++seed) {
      std::minstd_rand random(static_cast<unsigned>(seed + 1));
      std::string bytes(kVoxels, '\0');
      for (char& byte : bytes) byte = static_cast<char>(random() >> 16U);
      contents_.push_back(bytes);
    }
    write_file(source_, contents_[0]);
    set_time();
  }

  int draw(int below) { return static_cast<int>(random_() % static_cast<std::uint64_t>(below)); }

  // Replaces the source as `cp -p` and `rsync -t` do: size and modification time stay.
  void replace_source() {
    const std::string& content = contents_[static_cast<std::size_t>(draw(static_cast<int>(contents_.size())))];
    if (draw(2) == 0) {
      std::fstream(source_, std::ios::binary | std::ios::in | std::ios::out) << content;  // the same inode
    } else {
      write_file(source_ + ".new", content);
      fs::rename(source_ + ".new", source_);
    }
    set_time();
  }
  void set_time() const {
    const timespec times[2]{{1'700'000'000, 0}, {1'700'000'000, 0}};
    ASSERT_EQ(utimensat(AT_FDCWD, source_.c_str(), times, 0), 0);
  }

  Json record() const { return Json::parse(read_file(output_ + ".json")); }
  // Returns whether the certificate equals a comparison with the present source.
  bool certifies_source() const {
    const CommandResult compared = run_weir({"compare", source_, output_, "--json"});
    EXPECT_EQ(compared.exit_code, 0) << compared.err;
    const Json found = Json::parse(compared.out);
    const Json said = record()["error"];
    return std::abs(found["mse"].get<double>() - said["mse"].get<double>()) <= 1e-9 * said["mse"].get<double>() &&
           found["max_abs"] == said["max_abs"];
  }

  std::mt19937_64 random_{7};
  TemporaryDirectory directory_;
  std::string source_ = directory_ / "v_96x96x96_uint8.raw";
  std::string output_ = directory_ / "out/v.nvdb";
  std::vector<std::string> contents_;
};

TEST_F(ReplacedSourceProperty, AnyKillAndReplacement_NeverCertifiesAnotherVolume) {
  const char* const asked = std::getenv("WEIR_PROPERTY_VOLUMES");
  const int runs = asked == nullptr ? 60 : std::stoi(asked);
  const std::vector<std::string> command{WEIR_COMMAND, "convert", source_,           "-o", output_,
                                         "--rate",     "4",       "--threads",       "1",  "--overwrite",
                                         "--resume",   "on",      "--save-interval", "0"};
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run_command(command).exit_code, 0);
  const auto one_run = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin);
  int ended = 0;
  for (int run = 0; run < runs; ++run) {
    if (draw(2) == 0) replace_source();
    ChildProcess child(command);
    std::this_thread::sleep_for(std::chrono::microseconds(draw(static_cast<int>(one_run.count()))));
    const int fate = draw(4);
    if (fate < 2) child.send_signal(SIGKILL);
    if (fate == 2) replace_source();
    const CommandResult result = child.wait();
    SCOPED_TRACE(cat("run ", run, ", fate ", fate, ": ", result.err));
    if (result.exit_code == 128 + SIGKILL) {
      // The output is complete or absent; it was committed before or by this run.
      if (fs::exists(output_) && fs::exists(output_ + ".json")) {
        EXPECT_EQ(run_weir({"verify", output_}).exit_code, 0);
      }
      continue;
    }
    if (result.exit_code == 3) {
      EXPECT_NE(result.err.find("changed while it was read"), std::string::npos);
      EXPECT_EQ(fate, 2);
      continue;
    }
    ASSERT_EQ(result.exit_code, 0);
    ++ended;
    if (fate != 2) {  // otherwise it may have been replaced after the last look at it
      EXPECT_TRUE(certifies_source());
    }
  }
  EXPECT_GT(ended, runs / 8);
  EXPECT_EQ(run_command(command).exit_code, 0);
  EXPECT_TRUE(certifies_source());
  EXPECT_EQ(list_directory(directory_ / "out"), (std::vector<std::string>{"v.nvdb", "v.nvdb.json"}));
}

}  // namespace
}  // namespace weir::replaced_source_property_test
