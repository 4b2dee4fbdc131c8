#include "daemon/watch/completion.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/plotfile_writer.h"
#include "tests/support/temporary_directory.h"

namespace weir::completion_test {
namespace {

using namespace std::chrono_literals;
using Kind = FileEventKind;
using State = CompletionAnswer::State;
using Time = FileCompletion::Time;

class CompletionTest : public testing::Test {
 protected:
  /// Sends an event at a second of an imagined day, and returns the answer to the sample that follows.
  CompletionAnswer at(double seconds, std::optional<Kind> event = std::nullopt) {
    now = start + std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(seconds));
    if (event) file().happened(*event, now);
    return file().look(sample, now);
  }
  FileCompletion& file() {
    if (!file_) file_.emplace(rules);
    return *file_;
  }
  void grow(std::uint64_t bytes) {
    sample.identity.bytes = bytes;
    ++sample.identity.mtime_ns;
  }

  /// Returns the second at which `answer` asks for the next look.
  double again(const CompletionAnswer& answer) const {
    EXPECT_EQ(answer.state, State::waiting) << answer.reason;
    return std::chrono::duration<double>(answer.until - start).count();
  }
  void expect_event_is_awaited(const CompletionAnswer& answer, const std::string& reason) const {
    EXPECT_EQ(answer.state, State::waiting);
    EXPECT_EQ(answer.until, Time::max());
    EXPECT_EQ(answer.reason, reason);
  }

  const Time start = Time() + 1000h;
  Time now = start;
  CompletionRules rules;
  FileSample sample{true, {100, 1, 7}, false};

 private:
  std::optional<FileCompletion> file_;
};

constexpr const char* kOpen = "a program has it open for writing";

TEST_F(CompletionTest, AutoFoundIsCompleteWhenUnchangedForTheSettleTime) {
  EXPECT_DOUBLE_EQ(again(at(0, Kind::found)), 2);
  grow(200);
  EXPECT_DOUBLE_EQ(again(at(1.9)), 3.9);
  EXPECT_DOUBLE_EQ(again(at(2)), 3.9);
  sample.identity.inode = 8;  // replaced by another file
  EXPECT_DOUBLE_EQ(again(at(3)), 5);
  EXPECT_EQ(at(5).state, State::complete);
}

TEST_F(CompletionTest, AutoAnOpenFileIsWaitedForHoweverLong) {
  at(0, Kind::created);
  expect_event_is_awaited(at(1, Kind::written), kOpen);
  expect_event_is_awaited(at(100000), kOpen);
  EXPECT_DOUBLE_EQ(again(at(100001, Kind::closed)), 100001.2);
  expect_event_is_awaited(at(100001.1, Kind::written), kOpen);  // a second writer, or the same one again
  EXPECT_DOUBLE_EQ(again(at(100001.15, Kind::closed)), 100001.35);
  EXPECT_EQ(at(100001.35).state, State::complete);
}

TEST_F(CompletionTest, AutoAClosedFileThatStillChangesIsWaitedFor) {
  EXPECT_DOUBLE_EQ(again(at(0, Kind::closed)), 0.2);
  grow(101);  // through a mapping, or from another machine
  EXPECT_DOUBLE_EQ(again(at(0.2)), 0.4);
  EXPECT_EQ(at(0.4).state, State::complete);
}

TEST_F(CompletionTest, AutoOfExpectedSizeAndClosedIsCompleteAtOnce) {
  rules.expected_bytes = 100;
  EXPECT_EQ(at(0, Kind::closed).state, State::complete);
}

TEST_F(CompletionTest, AutoAFileMadeAtItsFullSizeIsNotCompleteBeforeItsClose) {
  rules.expected_bytes = 100;
  EXPECT_DOUBLE_EQ(again(at(0, Kind::created)), 2);
  expect_event_is_awaited(at(0, Kind::written), kOpen);  // the writer reserved the space
  EXPECT_EQ(at(50, Kind::closed).state, State::complete);
}

TEST_F(CompletionTest, AutoRenamedIsCompleteAtOnce) {
  EXPECT_EQ(at(0, Kind::moved_in).state, State::complete);
  expect_event_is_awaited(at(1, Kind::written), kOpen);
}

TEST_F(CompletionTest, AutoLinkedIsCompleteWhenUnchanged) {
  EXPECT_DOUBLE_EQ(again(at(0, Kind::created)), 2);
  EXPECT_EQ(at(2).state, State::complete);
}

TEST_F(CompletionTest, FoundAgainAfterLostEvents_IsNotTakenForOpen) {
  at(0, Kind::written);
  at(5, Kind::overflow);
  EXPECT_EQ(at(10, Kind::found).state, State::complete);  // unchanged since second 0
}

// A writer through a mapping causes this: a look finds other times, and no event reports the change.
TEST_F(CompletionTest, FoundAgainWhileItIsOpen_IsStillOpen) {
  at(0, Kind::written);
  grow(200);
  EXPECT_EQ(at(10, Kind::found).state, State::waiting);
  EXPECT_EQ(at(600, Kind::found).state, State::waiting);
  EXPECT_EQ(at(601, Kind::closed).state, State::waiting) << "for a moment";
  EXPECT_EQ(at(602).state, State::complete);
}

TEST_F(CompletionTest, EmptyFile_IsAwaitedThenBrokenOnceItsWriterCloses) {
  sample.identity.bytes = 0;
  at(0, Kind::created);
  expect_event_is_awaited(at(100), "it is empty");
  const CompletionAnswer closed = at(101.5, Kind::closed);
  EXPECT_DOUBLE_EQ(again(closed), 101.7);
  EXPECT_EQ(at(102).state, State::broken);
  EXPECT_EQ(at(102).reason, "is empty (0 bytes); write it again");
}

TEST_F(CompletionTest, TruncatedFile_IsBrokenUntilItIsWrittenAgain) {
  rules.expected_bytes = 128;
  again(at(0, Kind::closed));
  const CompletionAnswer answer = at(0.2);
  EXPECT_EQ(answer.state, State::broken);
  EXPECT_EQ(answer.reason,
            "has 100 bytes and should have 128; write it again, or correct its name or dims, type and offset");
  grow(128);
  EXPECT_EQ(at(5, Kind::closed).state, State::complete);
}

TEST_F(CompletionTest, RemovedFile_IsReportedGone) {
  sample = {};
  EXPECT_EQ(at(0, Kind::removed).state, State::gone);
}

TEST_F(CompletionTest, Close) {
  rules.policy = Completion::close;
  expect_event_is_awaited(at(0, Kind::written), kOpen);
  EXPECT_EQ(at(1, Kind::closed).state, State::complete);
  EXPECT_DOUBLE_EQ(again(at(2, Kind::found)), 3);  // unchanged since second 1
  EXPECT_EQ(at(3).state, State::complete);
}

TEST_F(CompletionTest, Rename) {
  rules.policy = Completion::rename;
  expect_event_is_awaited(at(0, Kind::closed), "it has not got its name by a rename");
  EXPECT_EQ(at(1, Kind::moved_in).state, State::complete);
  EXPECT_EQ(at(2, Kind::found).state, State::complete);
}

TEST_F(CompletionTest, Rename_FileThatWasCreated_WaitsForItsRename) {
  constexpr const char* kNoRename = "it has not got its name by a rename";
  rules.policy = Completion::rename;
  sample.identity.bytes = 0;
  expect_event_is_awaited(at(0, Kind::created), kNoRename);
  grow(100);  // by ftruncate, which causes no event
  expect_event_is_awaited(at(3), kNoRename);
  expect_event_is_awaited(at(4, Kind::written), kNoRename);
  EXPECT_EQ(at(5, Kind::moved_in).state, State::complete);
  expect_event_is_awaited(at(6, Kind::created), kNoRename);
  EXPECT_EQ(at(7, Kind::found).state, State::complete) << "after a restart, say";
}

TEST_F(CompletionTest, Rename_FileRewrittenAfterItsRename_IsCompleteWhenItHasNoWriterAndIsUnchanged) {
  rules.policy = Completion::rename;
  bool open = true;
  rules.has_writer = [&] { return open; };
  EXPECT_EQ(at(0, Kind::moved_in).state, State::complete);
  grow(200);
  const CompletionAnswer answer = at(1, Kind::written);
  EXPECT_DOUBLE_EQ(again(answer), 3);
  EXPECT_EQ(answer.reason, kOpen);
  open = false;
  EXPECT_DOUBLE_EQ(again(at(4, Kind::closed)), 6);
  EXPECT_EQ(at(6).state, State::complete);
}

TEST_F(CompletionTest, Rename_ChangedSource_IsCompleteWithoutARenameUnlessItWasCreatedAnew) {
  rules.policy = Completion::rename;
  expect_event_is_awaited(at(0, Kind::closed), "it has not got its name by a rename");
  file().source_before();
  EXPECT_DOUBLE_EQ(again(at(1)), 2) << "unchanged since 0";
  EXPECT_EQ(at(2).state, State::complete);
  at(3, Kind::created);
  grow(300);
  file().source_before();
  expect_event_is_awaited(at(4, Kind::closed), "it has not got its name by a rename");
}

TEST_F(CompletionTest, Rename_FileThatWasFoundWithAWriter_IsCompleteWhenItHasNoneAndIsUnchanged) {
  rules.policy = Completion::rename;
  bool open = true;
  rules.has_writer = [&] { return open; };
  const CompletionAnswer answer = at(0, Kind::found);
  EXPECT_DOUBLE_EQ(again(answer), 2);
  EXPECT_EQ(answer.reason, kOpen);
  grow(200);
  EXPECT_DOUBLE_EQ(again(at(1, Kind::written)), 3);
  open = false;
  EXPECT_DOUBLE_EQ(again(at(2, Kind::closed)), 4) << "unchanged since 2";
  EXPECT_EQ(at(4).state, State::complete);
  open = true;
  EXPECT_EQ(again(at(5, Kind::found)), 7) << "events were lost, say";
  EXPECT_EQ(at(6, Kind::moved_in).state, State::complete);
  expect_event_is_awaited(at(7, Kind::created), "it has not got its name by a rename");
}

TEST_F(CompletionTest, Close_FileThatWasFoundWithAWriter_IsNotCompleteBeforeItHasNone) {
  rules.policy = Completion::close;
  bool open = true;
  rules.has_writer = [&] { return open; };
  at(0, Kind::found);
  const CompletionAnswer answer = at(10);  // unchanged for longer than required
  EXPECT_EQ(answer.state, State::waiting);
  EXPECT_EQ(answer.reason, kOpen);
  open = false;
  EXPECT_EQ(at(12).state, State::complete);
}

// A program may create a directory and a file in it before the directory is watched.
TEST_F(CompletionTest, Rename_RulesOfAFileKnowItsWriter) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a_4x4x4_uint8.raw";
  WatchConfig watch;
  EXPECT_FALSE(completion_rules(watch, path).has_writer);
  watch.complete = Completion::close;
  EXPECT_TRUE(completion_rules(watch, path).has_writer);
  watch.complete = Completion::rename;
  const CompletionRules found = completion_rules(watch, path);
  std::ofstream writer(path);
  writer << "some of it" << std::flush;
  EXPECT_TRUE(found.has_writer());
  writer.close();
  EXPECT_FALSE(found.has_writer());
}

TEST_F(CompletionTest, Rename_EmptyFileThatWasFound_IsAwaited) {
  rules.policy = Completion::rename;
  sample.identity.bytes = 0;
  expect_event_is_awaited(at(0, Kind::found), "it is empty");
  grow(100);
  EXPECT_EQ(at(1, Kind::found).state, State::complete);
  sample.identity.bytes = 0;
  EXPECT_EQ(at(2, Kind::moved_in).state, State::broken);
  EXPECT_EQ(at(2).reason, "is empty (0 bytes); write it again");
}

TEST_F(CompletionTest, Marker) {
  rules.policy = Completion::marker;
  rules.marker = ".done";
  expect_event_is_awaited(at(0, Kind::closed), "its marker *.done is not there");
  sample.marked = true;
  EXPECT_EQ(at(9, Kind::marked).state, State::complete);
  grow(200);
  EXPECT_DOUBLE_EQ(again(at(10, Kind::written)), 10.2);  // the marker belongs to the former content
  EXPECT_EQ(at(10.2).state, State::complete);
}

TEST_F(CompletionTest, Size) {
  rules.policy = Completion::size;
  rules.expected_bytes = 300;
  EXPECT_DOUBLE_EQ(again(at(0, Kind::written)), 2);
  EXPECT_EQ(at(0).reason, "it has 100 of 300 bytes");
  grow(300);
  EXPECT_DOUBLE_EQ(again(at(50, Kind::written)), 50.2);
  EXPECT_EQ(at(50.2).state, State::complete);  // the file may stay open
  grow(299);
  EXPECT_DOUBLE_EQ(again(at(60, Kind::closed)), 62);
  EXPECT_EQ(at(62).state, State::broken);
}

TEST_F(CompletionTest, SizePolicy_ExpectedSizeUnknown_IsBroken) {
  rules.policy = Completion::size;
  EXPECT_EQ(at(0, Kind::found).state, State::broken);
  EXPECT_EQ(at(0).reason, "its size cannot be known; name it NAME_XxYxZ_TYPE.raw or give dims and type");
}

TEST_F(CompletionTest, Stable) {
  rules.policy = Completion::stable;
  rules.settle = 5s;
  at(0, Kind::created);
  EXPECT_DOUBLE_EQ(again(at(1, Kind::written)), 6);
  EXPECT_DOUBLE_EQ(again(at(2, Kind::closed)), 7);
  EXPECT_EQ(at(7).state, State::complete);
}

TEST(CompletionRulesTest, ExpectedSizesOfRawFiles) {
  WatchConfig watch;
  const auto expected = [&](const std::string& path) { return completion_rules(watch, path).expected_bytes; };
  EXPECT_EQ(expected("/in/a_4x5x6_uint16.raw"), 240U);
  EXPECT_EQ(expected("/in/a_4x5x6_float64be.raw"), 960U);
  EXPECT_EQ(expected("/in/a_4x5x6_quaternion.raw"), std::nullopt);
  EXPECT_EQ(expected("/in/a_4x0x6_uint8.raw"), std::nullopt);
  EXPECT_EQ(expected("/in/a_99999999x99999999x99999999_uint8.raw"), std::nullopt);
  EXPECT_EQ(expected("/in/a.h5"), std::nullopt);
  watch.convert_options = {"--dims=2,3,4", "--type=float32", "--offset=10"};
  EXPECT_EQ(expected("/in/a.bin"), 106U);
  watch.convert_options = {"--offset=10"};
  EXPECT_EQ(expected("/in/a_2x2x2_uint8.raw"), 18U);
  watch.settle_s = 0.25;
  EXPECT_EQ(completion_rules(watch, "/in/a.h5").settle, 250ms);
}

TEST(FileSampleTest, RegularFilesAndTheirMarkers) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.raw";
  EXPECT_FALSE(sample_file(path, ".done").exists);
  std::ofstream(path) << "12345";
  FileSample sample = sample_file(path, ".done");
  EXPECT_TRUE(sample.exists);
  EXPECT_EQ(sample.identity.bytes, 5U);
  EXPECT_FALSE(sample.marked);
  std::ofstream(path + ".done") << "";
  EXPECT_TRUE(sample_file(path, ".done").marked);
  EXPECT_FALSE(sample_file(path, "").marked);
  EXPECT_FALSE(sample_file(directory.path().string(), "").exists);
  EXPECT_FALSE(sample_file(path + "/below", "").exists);
  EXPECT_FALSE(sample_file(directory / std::string(300, 'n'), "").exists);
}

TEST_F(CompletionTest, APlotfileIsWaitedForUntilAllOfItIsWritten) {
  std::string rest = "Level_1/Cell_H is not there";
  rules.unwritten = [&] { return rest; };
  EXPECT_DOUBLE_EQ(again(at(0, Kind::closed)), 0.2);
  const CompletionAnswer answer = at(0.2);
  EXPECT_DOUBLE_EQ(again(answer), 2.2);
  EXPECT_EQ(answer.reason, rest);
  EXPECT_DOUBLE_EQ(again(at(2.2)), 4.2);
  rest.clear();
  EXPECT_EQ(at(4.2).state, State::complete);
}

TEST_F(CompletionTest, BySize_DirectoriesHaveNoneAndAreTakenWhenNothingChanges) {
  rules.policy = Completion::size;
  bool written = false;
  rules.unwritten = [&] { return std::string(written ? "" : "Level_1/Cell_H is not there"); };
  EXPECT_DOUBLE_EQ(again(at(0, Kind::closed)), 2);
  EXPECT_EQ(at(2).reason, "Level_1/Cell_H is not there");
  written = true;
  EXPECT_EQ(at(4).state, State::complete);
  const TemporaryDirectory directory;
  WatchConfig watch;
  watch.complete = Completion::size;
  const std::string head = directory / "run.zarr/zarr.json";
  std::filesystem::create_directory(directory / "run.zarr");
  std::ofstream(head) << "{}";
  FileCompletion store(completion_rules(watch, head));
  EXPECT_EQ(store.look(sample_file(head, ""), start).reason, "it changed a moment ago");
  EXPECT_EQ(store.look(sample_file(head, ""), start + 2s).reason, "it has 1 files, 2 B, and may still be written");
  EXPECT_EQ(store.look(sample_file(head, ""), start + 4s).state, State::complete);
}

TEST(PlotfileCompletion, RulesLookForAllFilesAndSamplesForItsHeader) {
  const TemporaryDirectory directory;
  const std::string header = directory / "plt00042/Header";
  const WatchConfig watch;
  EXPECT_FALSE(completion_rules(watch, directory / "a.h5").unwritten);
  test::write_plotfile(directory / "plt00042", {});
  const CompletionRules rules = completion_rules(watch, header);
  EXPECT_TRUE(sample_file(header, "").exists);
  EXPECT_EQ(rules.unwritten(), "");
  std::filesystem::remove(directory / "plt00042/Level_0/Cell_H");
  EXPECT_EQ(rules.unwritten(),
            directory / "plt00042/Level_0/Cell_H: cannot open for reading: No such file or directory");
  std::ofstream(header) << "CheckPointVersion_1.0\n";
  EXPECT_FALSE(sample_file(header, "").exists);
}

TEST(ZarrCompletion, SamplesAreOfTheFileThatSaysWhatItIs) {
  const TemporaryDirectory directory;
  const std::string store = directory / "run.zarr";
  std::filesystem::create_directory(store);
  const WatchConfig watch;
  std::ofstream(store + "/.zgroup") << "{}";
  EXPECT_TRUE(sample_file(store + "/.zgroup", "").exists);
  EXPECT_TRUE(completion_rules(watch, store + "/.zgroup").store);
  std::ofstream(store + "/zarr.json") << "{}";  // the metadata of both versions are one input
  EXPECT_FALSE(sample_file(store + "/.zgroup", "").exists);
  EXPECT_TRUE(sample_file(store + "/zarr.json", "").exists);
  WatchConfig by_marker;
  by_marker.complete = Completion::marker;
  EXPECT_FALSE(completion_rules(by_marker, store + "/zarr.json").store);
}

}  // namespace
}  // namespace weir::completion_test
