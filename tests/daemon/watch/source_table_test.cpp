#include "daemon/watch/source_table.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::source_table_test {
namespace {

class SourceTableTest : public ::testing::Test {
 protected:
  static WatchConfig watch() {
    WatchConfig config;
    config.label = config.directory = "/in";
    return config;
  }
  /// Looks while events report changes.
  void look(const FileIdentity& identity) {
    table_.begin_look(true);
    table_.saw("a.raw", identity);
    table_.end_look();
  }

  std::vector<FileEventKind> events_;
  SourceTable table_{watch(), {[this](const FileEvent& event) { events_.push_back(event.kind); }, {}}};
};

// For example a write through another hard link, which inotify does not report.
TEST_F(SourceTableTest, ChangeThatNoEventTold_IsFoundByTheSecondLookAfterTheLastEvent) {
  table_.begin_look(true);
  table_.end_look();
  table_.happened(FileEventKind::created, "a.raw");
  table_.happened(FileEventKind::closed, "a.raw");
  events_.clear();
  look({8, 1, 1});
  EXPECT_TRUE(events_.empty()) << "events told of it";
  look({8, 1, 1});
  EXPECT_TRUE(events_.empty()) << "nothing has changed";
  look({8, 2, 1});
  EXPECT_EQ(events_, std::vector<FileEventKind>{FileEventKind::found});
  table_.happened(FileEventKind::written, "a.raw");
  events_.clear();
  look({8, 3, 1});
  EXPECT_TRUE(events_.empty()) << "the event told of it";
}

// Jobs of files that seemed to be gone may have been forgotten.
TEST(SourceTableRoot, FilesOfADirectoryThatIsBack_AreFoundOnceMore) {
  const TemporaryDirectory parent;
  WatchConfig watch;
  watch.label = watch.directory = parent / "in";
  std::filesystem::create_directory(watch.directory);
  write_file(parent / "in/a.raw", "x");
  std::vector<FileEventKind> events;
  SourceTable table{watch, {[&](const FileEvent& event) { events.push_back(event.kind); }, {}}};
  const auto look = [&] {
    table.begin_look(true);
    table.saw("a.raw", {1, 1, 1});
    table.end_look();
  };
  EXPECT_EQ(table.look_at_root(), SourceTable::Root::another);
  look();
  EXPECT_EQ(table.look_at_root(), SourceTable::Root::same);
  look();
  EXPECT_EQ(events, std::vector<FileEventKind>{FileEventKind::found});
  std::filesystem::rename(parent / "in", parent / "away");
  EXPECT_EQ(table.look_at_root(), SourceTable::Root::missing);
  std::filesystem::rename(parent / "away", parent / "in");
  EXPECT_EQ(table.look_at_root(), SourceTable::Root::another);
  events.clear();
  look();
  look();
  EXPECT_EQ(events, std::vector<FileEventKind>{FileEventKind::found});
}

}  // namespace
}  // namespace weir::source_table_test
