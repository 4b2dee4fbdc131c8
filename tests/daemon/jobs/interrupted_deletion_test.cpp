// Tests sources that an interrupted deletion has left under a hidden name.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon/jobs/hidden_sources.h"
#include "format/io/descriptor.h"
#include "tests/daemon/support/deleting_watch.h"

namespace weir::interrupted_deletion_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

using InterruptedDeletion = DeletingWatch;

// A process may be killed between the two steps of a deletion.
TEST_F(InterruptedDeletion, LeftUnderTheHiddenName_IsDeletedByTheNextProcess) {
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  deletion_.configure(config_);
  EXPECT_TRUE(run_until([&] { return deletion_.idle(); }));
  EXPECT_EQ(list_directory(directory_ / "in"), Names{});
  EXPECT_TRUE(logged(" deleted job=1 source=" + source_));
}

TEST_F(InterruptedDeletion, LeftUnderTheHiddenNameWithoutItsOutput_GetsItsNameBack) {
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  fs::remove(output_);
  deletion_.configure(config_);
  EXPECT_TRUE(stays());
  EXPECT_EQ(read_file(source_), "values");
  EXPECT_TRUE(logged(output_ + " is not there as it was; let its job be done again (weir retry --force 1)"));
}

TEST_F(InterruptedDeletion, LeftUnderTheHiddenNameWithItsMarker_IsDeletedWithIt) {
  config_.watches[0].complete = Completion::marker;
  write_file(source_ + ".done", "");
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  deletion_.configure(config_);
  EXPECT_TRUE(run_until([&] { return deletion_.idle(); }));
  EXPECT_EQ(list_directory(directory_ / "in"), Names{});
}

TEST_F(InterruptedDeletion, LeftUnderTheHiddenNameBehindItsMarker_GetsItBackWithItsName) {
  config_.watches[0].complete = Completion::marker;
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  fs::remove(output_);
  deletion_.configure(config_);
  EXPECT_TRUE(stays());
  EXPECT_EQ(list_directory(directory_ / "in"), (Names{"a_1x2x3_uint8.raw", "a_1x2x3_uint8.raw.done"}));
}

TEST_F(InterruptedDeletion, MarkerOfTheNextFileOfThatName_Stays) {
  config_.watches[0].complete = Completion::marker;
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  pass_file_tick();
  write_file(source_, "newer");
  write_file(source_ + ".done", "");
  deletion_.configure(config_);
  EXPECT_TRUE(run_until([&] { return deletion_.idle(); }));
  EXPECT_EQ(list_directory(directory_ / "in"), (Names{"a_1x2x3_uint8.raw", "a_1x2x3_uint8.raw.done"}));
  EXPECT_EQ(read_file(source_), "newer");
}

TEST_F(InterruptedDeletion, LeftUnderTheHiddenNameWhoseNameIsTaken_IsSaid) {
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  fs::remove(output_);
  write_file(source_, "newer");
  deletion_.configure(config_);
  EXPECT_TRUE(stays());
  EXPECT_EQ(read_file(hidden(id)), "values");
  EXPECT_TRUE(logged(hidden(id) + " is the source, which a deletion that was interrupted has left; give it a name"));
}

TEST_F(InterruptedDeletion, AnotherFileUnderTheHiddenName_GetsItsNameBack) {
  const std::int64_t id = convert();
  fs::remove(source_);
  write_file(hidden(id), "what came meanwhile");
  deletion_.configure(config_);
  EXPECT_TRUE(stays());
  EXPECT_EQ(read_file(source_), "what came meanwhile");
  EXPECT_EQ(list_directory(directory_ / "in").size(), 1U);
}

// A former version of the service also deleted links and could leave this.
TEST_F(InterruptedDeletion, LinkToTheSourceUnderTheHiddenName_GetsItsNameBack) {
  const std::string target = directory_ / "in/.target";
  const std::int64_t id = convert();
  fs::rename(source_, target);
  fs::create_symlink(target, hidden(id));
  deletion_.configure(config_);
  EXPECT_TRUE(run_until([&] { return deletion_.idle(); }));
  EXPECT_TRUE(fs::is_symlink(source_));
  EXPECT_EQ(read_file(target), "values");
  EXPECT_FALSE(logged(" deleted "));
}

TEST_F(InterruptedDeletion, AnotherFileUnderTheHiddenNameWhoseNameIsTaken_IsSaid) {
  const std::int64_t id = convert();
  write_file(hidden(id), "what came meanwhile");
  write_file(source_, "newer");
  deletion_.configure(config_);
  EXPECT_TRUE(stays());
  EXPECT_EQ(read_file(hidden(id)), "what came meanwhile");
  EXPECT_TRUE(logged(hidden(id) + " is another file, which a deletion that was interrupted has left; give it a name"))
      << read_file(directory_ / "log");
}

TEST_F(InterruptedDeletion, WriterOfTheHiddenSource_IsWaitedFor) {
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  Descriptor writer(::open(hidden(id).c_str(), O_WRONLY | O_CLOEXEC));
  deletion_.configure(config_);
  ASSERT_TRUE(run_until([&] { return logged("a program has it open for writing; tried again later"); }));
  EXPECT_EQ(read_file(hidden(id)), "values");
  writer.reset();
  EXPECT_TRUE(run_until([&] { return deletion_.idle(); }));
  EXPECT_EQ(list_directory(directory_ / "in"), Names{});
}

// The source belongs to another user. The service can neither take a lease nor look into the other processes.
class InterruptedDeletionOfAnotherUser : public DeletingWatch {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "only root has other users' files";
    fs::rename(source_, hidden(convert()));
    ASSERT_EQ(::chmod(directory_.path().c_str(), 0755), 0);
    ASSERT_EQ(::chmod((directory_ / "in").c_str(), 0777), 0);
  }
  void delete_as_nobody() {
    ASSERT_EQ(::seteuid(65534), 0);
    deletion_.configure(config_);
    EXPECT_TRUE(run_until([&] { return deletion_.idle(); }));
    ASSERT_EQ(::seteuid(0), 0);
  }
};

TEST_F(InterruptedDeletionOfAnotherUser, WritersThatCannotBeKnown_GiveTheNameBack) {
  delete_as_nobody();
  EXPECT_EQ(list_directory(directory_ / "in"), Names{"a_1x2x3_uint8.raw"});
  EXPECT_TRUE(logged(" reason=\"whether a program writes to it cannot be known here; "));
  EXPECT_FALSE(logged(" deleted "));
}

TEST_F(InterruptedDeletionOfAnotherUser, WriterThatSaysWhenItIsDone_IsDeletedAndNotCalledUnused) {
  config_.watches[0].complete = Completion::rename;
  delete_as_nobody();
  EXPECT_EQ(list_directory(directory_ / "in"), Names{});
  EXPECT_TRUE(logged(" in_use=\"not known\""));
}

TEST_F(InterruptedDeletion, WatchThatKeepsSourcesNow_GivesTheNameBack) {
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  config_.watches[0].source = AfterDone::keep;
  config_.watches[0].complete = Completion::marker;
  deletion_.configure(config_);
  EXPECT_TRUE(run_until([&] { return logged(hidden(id) + "; it has its name back"); }));
  EXPECT_EQ(read_file(source_), "values");
  EXPECT_TRUE(fs::exists(source_ + ".done"));
  EXPECT_FALSE(fs::exists(hidden(id)));
}

TEST_F(InterruptedDeletion, JobThatIsToBeDoneAgain_GetsItsSourceBack) {
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  store_.retry(id, true);
  deletion_.configure(config_);
  EXPECT_TRUE(run_until([&] { return logged(hidden(id) + "; it has its name back"); }));
  EXPECT_EQ(read_file(source_), "values");
}

TEST_F(InterruptedDeletion, WatchThatKeepsSourcesNow_ReplacesNoNewerOne) {
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  write_file(source_, "newer");
  config_.watches[0].source = AfterDone::keep;
  deletion_.configure(config_);
  EXPECT_TRUE(run_until([&] {
    return logged(hidden(id) + " is the source, which a deletion that was interrupted has left; give it a name");
  }));
  EXPECT_EQ(read_file(source_), "newer");
  EXPECT_EQ(read_file(hidden(id)), "values");
}

// After the loss of the state file, for example, the number in the hidden name may belong to another job or to none.
TEST_F(InterruptedDeletion, SourceThatNoJobKnows_IsSaidAndStays) {
  const std::int64_t id = convert();
  config_.watches[0].recursive = true;
  fs::create_directory(directory_ / "in/sub");
  const Names unknown{hidden(7), directory_ / "in/sub/.weir-delete-" + std::to_string(id)};
  for (const std::string& path : unknown) write_file(path, "of another time");
  deletion_.configure(config_);
  for (const std::string& path : unknown) {
    EXPECT_TRUE(run_until([&] {
      return logged(" not-deleted source=" + path +
                    " reason=\"a deletion that was interrupted has left a source under this name, and no job tells its "
                    "own; give it that, or remove it\"");
    })) << path;
    EXPECT_EQ(read_file(path), "of another time");
  }
  EXPECT_TRUE(run_until([&] { return deletion_.idle(); }));
  EXPECT_FALSE(fs::exists(source_)) << "of the job, which is deleted as ever";
}

TEST_F(InterruptedDeletion, SourceIsLookedForWhereTheWatchLooks) {
  const Names seen{directory_ / "in/.weir-delete-1"};
  const Names below{directory_ / "in/.weir-delete-1", directory_ / "in/sub/.weir-delete-2"};
  for (const char* sub : {"in/sub", "in/a.zarr/c", "in/.hidden"}) fs::create_directories(directory_ / sub);
  for (const char* name : {"in/.weir-delete-1", "in/sub/.weir-delete-2", "in/a.zarr/c/.weir-delete-3",
                           "in/.hidden/.weir-delete-4", "in/.weir-delete-", "in/.weir-delete-x"}) {
    write_file(directory_ / name, "values");
  }
  const auto found = [&](HiddenSources& hidden) {
    Names paths;
    hidden.look_through(config_.watches);
    while (!hidden.idle()) {
      for (const HiddenSource& source : hidden.step()) paths.push_back(source.path);
    }
    std::sort(paths.begin(), paths.end());
    return paths;
  };
  HiddenSources hidden;
  EXPECT_EQ(found(hidden), seen);
  EXPECT_EQ(found(hidden), Names{}) << "once only";
  config_.watches[0].recursive = true;
  EXPECT_EQ(found(hidden), below);
}

}  // namespace
}  // namespace weir::interrupted_deletion_test
