// Tests which volumes the viewers' shelf keeps, and which volumes are dropped if there is no room.
#include "tools/view/volume_shelf.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "tests/support/message_of_error.h"
#include "tests/support/packed_sample.h"
#include "tests/support/temporary_directory.h"

namespace weir::volume_shelf_test {
namespace {

class CountedVolume : public LoadedVolume {
 public:
  explicit CountedVolume(std::atomic<int>& alive) : alive_(alive) { ++alive_; }
  ~CountedVolume() override { --alive_; }
  const VolumeInfo& info() const override { return info_; }
  const LoadSummary& load_summary() const override { return summary_; }

 private:
  std::atomic<int>& alive_;
  VolumeInfo info_;
  LoadSummary summary_;
};

// A back end that has room for a fixed number of volumes.
class NarrowBackend : public Backend {
 public:
  std::string_view name() const override { return "narrow"; }
  std::unique_ptr<LoadedVolume> load(std::shared_ptr<const NvdbFile>, std::int64_t,
                                     std::unique_ptr<LoadedVolume>) override {
    ++loads;
    if (alive >= room) throw Error(ErrorKind::io, "no room");
    return std::make_unique<CountedVolume>(alive);
  }
  std::unique_ptr<LoadedVolume> load_dense(std::shared_ptr<const DenseVolume>, std::int64_t) override {
    return nullptr;
  }
  Picture render(LoadedVolume&, const Scene&, const RenderOptions&, const SampleOptions&) override { return {}; }

  std::atomic<int> room{2};
  std::atomic<int> alive{0};
  std::atomic<int> loads{0};
};

class VolumeShelfTest : public testing::Test {
 protected:
  VolumeShelfTest() {
    const test::PackedFile made = test::PackedSample::build();
    for (const char* name : {"a.nvdb", "b.nvdb", "c.nvdb"}) {
      files_.push_back(directory_ / name);
      std::ofstream(files_.back(), std::ios::binary)
          .write(reinterpret_cast<const char*>(made.file.data()), static_cast<std::streamsize>(made.file.size()));
    }
  }

  TemporaryDirectory directory_;
  std::vector<std::string> files_;
  NarrowBackend backend_;
};

TEST_F(VolumeShelfTest, NoRoomBesideTheOthers_TheseGo) {
  VolumeShelf shelf(backend_, 3);
  shelf.get(files_[0]);
  shelf.get(files_[1]);
  EXPECT_EQ(backend_.loads, 2);
  EXPECT_NE(shelf.get(files_[2]), nullptr);
  EXPECT_EQ(backend_.loads, 4) << "refused, and then alone";
  EXPECT_EQ(backend_.alive, 1);
  EXPECT_FALSE(shelf.has(files_[0]));
  EXPECT_TRUE(shelf.has(files_[2]));
}

TEST_F(VolumeShelfTest, NoRoomAtAll_IsAnErrorAndTheNextTryWorks) {
  VolumeShelf shelf(backend_, 2);
  backend_.room = 0;
  EXPECT_EQ(message_of_error(ErrorKind::io, [&] { shelf.get(files_[0]); }), "no room");
  EXPECT_EQ(backend_.loads, 1);
  backend_.room = 1;
  EXPECT_NE(shelf.get(files_[0]), nullptr);
}

// The step that is shown stays, whatever happens to the next step.
TEST_F(VolumeShelfTest, NoRoomForWhatIsLoadedAhead_NothingGoes) {
  VolumeShelf shelf(backend_, 2);
  backend_.room = 1;
  const auto seen = shelf.get(files_[0]);
  shelf.prefetch(files_[1]);
  for (int i = 0; i < 1000 && backend_.loads < 2; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(backend_.loads, 2);
  EXPECT_TRUE(shelf.has(files_[0]));
  EXPECT_EQ(message_of_error(ErrorKind::io, [&] { shelf.get(files_[1]); }), "no room") << "while it is in use";
}

TEST_F(VolumeShelfTest, AMissingFile_LeavesTheOthers) {
  VolumeShelf shelf(backend_, 2);
  shelf.get(files_[0]);
  EXPECT_THROW(shelf.get(directory_ / "none.nvdb"), Error);
  EXPECT_TRUE(shelf.has(files_[0]));
}

}  // namespace
}  // namespace weir::volume_shelf_test
