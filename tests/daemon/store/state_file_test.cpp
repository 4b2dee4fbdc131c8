#include "daemon/store/state_file.h"

#include <gtest/gtest.h>

#include "tests/support/run_command.h"
#include "tests/support/scoped_mount.h"
#include "tests/support/temporary_directory.h"

namespace weir::state_file_test {
namespace {

class StateFile : public testing::Test {
 protected:
  /// Returns the error message of opening; empty if it succeeds.
  std::string refusal() {
    try {
      open_state_file(path_, notice_);
      return "";
    } catch (const Error& error) {
      kind_ = error.kind();
      return error.what();
    }
  }
  /// Creates a state file with one row.
  void make() {
    const Database database = open_state_file(path_, notice_);
    database.run("INSERT INTO outputs VALUES (42, 0, '', 0, 0, NULL, '', NULL, NULL, NULL)");
  }
  std::int64_t marked() {
    const Database database = open_state_file(path_, notice_);
    Statement sum = database.prepare("SELECT coalesce(max(job), 0) FROM outputs");
    sum.step();
    return sum.integer(0);
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "weir.db";
  std::string notice_;
  ErrorKind kind_ = ErrorKind::internal;
};

TEST_F(StateFile, Reopened_HasItsContents) {
  make();
  EXPECT_EQ(marked(), 42);
  EXPECT_EQ(notice_, "");
  EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"weir.db"});
}

TEST_F(StateFile, OpenedByAnotherProcess_IsRefused) {
  const Database first = open_state_file(path_, notice_);
  EXPECT_EQ(refusal(), path_ +
                           ": cannot use the state: database is locked; another process has it open, and only one "
                           "weir watch may use a state file");
  EXPECT_EQ(kind_, ErrorKind::io);
}

TEST_F(StateFile, NewerVersion_IsRefusedAndUnchanged) {
  make();
  Database(path_).run("PRAGMA user_version=7");
  EXPECT_EQ(refusal(), path_ +
                           ": has version 7, this weir knows versions up to 5; run the newer weir or name another "
                           "file as state in [service]");
  EXPECT_EQ(kind_, ErrorKind::input);
  Database(path_).run("PRAGMA user_version=5");
  EXPECT_EQ(marked(), 42);
}

TEST_F(StateFile, Version1_IsUpgraded) {
  make();
  {
    const Database old(path_);
    for (const char* column : {"max_error", "min", "max"}) {
      old.run(std::string("ALTER TABLE outputs DROP COLUMN ") + column);
    }
    old.run(
        "INSERT INTO jobs (watch, source, options, bytes, mtime_ns, inode, state, discovered_ms, changed_ms, reason) "
        "VALUES ('w', '/a', '', 0, 0, 0, 'failed', 0, 0, '/a: has 7 bytes')");
    for (const char* index : {"jobs_waiting", "jobs_problem"}) old.run(std::string("DROP INDEX ") + index);
    for (const char* column : {"forced", "problem", "rendering", "source_bytes"})
      old.run(std::string("ALTER TABLE jobs DROP COLUMN ") + column);
    old.run("PRAGMA user_version=1");
  }
  EXPECT_EQ(marked(), 42);
  const Database database = open_state_file(path_, notice_);
  EXPECT_EQ(notice_, "");
  Statement row = database.prepare("SELECT user_version, max_error, min, max FROM outputs, pragma_user_version");
  ASSERT_TRUE(row.step());
  EXPECT_EQ(row.integer(0), 5);
  for (const int column : {1, 2, 3}) EXPECT_EQ(row.real_or_none(column), std::nullopt);
  Statement problem = database.prepare("SELECT problem FROM jobs");
  ASSERT_TRUE(problem.step());
  EXPECT_EQ(problem.text(0), "has # bytes");
  database.run("UPDATE outputs SET max = 2.5");
  Statement changed = database.prepare("SELECT max FROM outputs");
  ASSERT_TRUE(changed.step());
  EXPECT_EQ(changed.real_or_none(0), 2.5);
}

TEST_F(StateFile, Version2_IsUpgraded) {
  make();
  {
    const Database old(path_);
    for (const char* column : {"rendering", "source_bytes"})
      old.run(std::string("ALTER TABLE jobs DROP COLUMN ") + column);
    old.run("PRAGMA user_version=2");
  }
  EXPECT_EQ(marked(), 42);
  const Database database = open_state_file(path_, notice_);
  Statement version = database.prepare("PRAGMA user_version");
  ASSERT_TRUE(version.step());
  EXPECT_EQ(version.integer(0), 5);
  database.run("UPDATE jobs SET rendering = 1");
}

TEST_F(StateFile, Version3_KeepsJobsWithoutTheOptionsThatChangeNoByte) {
  make();
  {
    const Database old(path_);
    for (const char* options :
         {"output=/o/ --direct-io=off --rate=8.0", "output=/o/ --rate=4", "output=/o/ --direct-io=auto"}) {
      old.prepare(
             "INSERT INTO jobs (watch, source, options, bytes, mtime_ns, inode, state, discovered_ms, changed_ms) "
             "VALUES ('w', ?, ?, 0, 0, 0, 'done', 0, 0)")
          .bind(options)
          .bind(options)
          .step();
    }
    old.run("ALTER TABLE jobs DROP COLUMN source_bytes");
    old.run("PRAGMA user_version=3");
  }
  const Database database = open_state_file(path_, notice_);
  EXPECT_EQ(notice_, "");
  Statement row = database.prepare("SELECT options FROM jobs ORDER BY id");
  for (const char* options : {"output=/o/ --rate=8.0", "output=/o/ --rate=4", "output=/o/"}) {
    ASSERT_TRUE(row.step());
    EXPECT_EQ(row.text(0), options);
  }
}

TEST_F(StateFile, Version4_IsUpgraded) {
  make();
  {
    const Database old(path_);
    old.run("ALTER TABLE jobs DROP COLUMN source_bytes");
    old.run("PRAGMA user_version=4");
  }
  EXPECT_EQ(marked(), 42);
  const Database database = open_state_file(path_, notice_);
  EXPECT_EQ(notice_, "");
  database.run("UPDATE jobs SET source_bytes = 1");
}

TEST_F(StateFile, DatabaseOfAnotherProgram_IsRefusedAndUnchanged) {
  const std::string message = path_ + ": is a database of another program; name another file as state in [service]";
  Database(path_).run("CREATE TABLE theirs (a)");
  const std::string theirs = read_file(path_);
  EXPECT_EQ(refusal(), message);
  EXPECT_EQ(kind_, ErrorKind::input);
  EXPECT_EQ(read_file(path_) == theirs, true) << "it was written to";
  Database(path_).run("DROP TABLE theirs");
  Database(path_).run("PRAGMA application_id=1");
  EXPECT_EQ(refusal(), message);
  EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"weir.db"});
}

TEST_F(StateFile, FileThatWasNeverAStateFile_IsRefusedAndUnchanged) {
  for (const std::string& theirs : {std::string(5000, 'x'), std::string("x"), std::string("\x89HDF\r\n\x1a\n"),
                                    std::string("SQLite format 3"), std::string(68, 'x') + "wei"}) {
    write_file(path_, theirs);
    EXPECT_EQ(refusal(), path_ + ": is no state file of weir; name another file as state in [service]");
    EXPECT_EQ(kind_, ErrorKind::input);
    EXPECT_EQ(read_file(path_) == theirs, true) << "it was written to";
    EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"weir.db"});
  }
}

TEST_F(StateFile, FileThatShowsThatItWasAStateFile_IsMovedAside) {
  int n = 0;
  for (const std::string& damaged :
       {std::string("SQLite format 3\0", 16) + std::string(5000, 'x'), std::string(68, 'x') + "weir" + "xxxx",
        std::string(5000, '\0') + std::string(5000, 'x')}) {
    write_file(path_, damaged);
    EXPECT_EQ(marked(), 0);
    const std::string aside = path_ + ".corrupt-" + std::to_string(++n);
    EXPECT_EQ(notice_,
              path_ + ": cannot use the state: file is not a database; moved to " + aside + ", jobs are found anew");
    EXPECT_EQ(read_file(aside) == damaged, true);
  }
}

TEST_F(StateFile, FileThatIsNoDatabaseAndHasAJournal_IsMovedAside) {
  const std::string text(5000, 'x');
  for (const std::string n : {"1", "2"}) {
    write_file(path_, text);
    write_file(path_ + "-wal", "its journal");
    EXPECT_EQ(marked(), 0);
    EXPECT_EQ(notice_, path_ + ": cannot use the state: file is not a database; moved to " + path_ + ".corrupt-" + n +
                           ", jobs are found anew");
    EXPECT_EQ(read_file(path_ + ".corrupt-" + n), text);
  }
}

TEST_F(StateFile, TruncatedFile_IsMovedAside) {
  make();
  std::filesystem::resize_file(path_, 5 * 4096 + 100);
  EXPECT_EQ(marked(), 0);
  EXPECT_EQ(notice_, path_ + ": cannot use the state: database disk image is malformed; moved to " + path_ +
                         ".corrupt-1, jobs are found anew");
}

TEST_F(StateFile, WithADamagedPageIsMovedAside) {
  make();
  std::string bytes = read_file(path_);
  // The second page belongs to a table; its first byte is the page type.
  bytes.replace(4096, 512, 512, '\x7f');
  write_file(path_, bytes);
  EXPECT_EQ(marked(), 0);
  EXPECT_TRUE(notice_.ends_with("; moved to " + path_ + ".corrupt-1, jobs are found anew")) << notice_;
  EXPECT_EQ(read_file(path_ + ".corrupt-1"), bytes);
}

TEST_F(StateFile, EmptyFile_IsTreatedAsNew) {
  write_file(path_, "");
  EXPECT_EQ(marked(), 0);
  EXPECT_EQ(notice_, "");
}

TEST_F(StateFile, OnAReadOnlyFileSystemIsRefused) {
  ScopedMount mount(directory_.path(), 1 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  make();
  mount.make_read_only();
  EXPECT_EQ(refusal(), path_ + ": cannot use the state: it is read-only; make the file and its directory writable");
  EXPECT_EQ(kind_, ErrorKind::io);
  path_ = directory_ / "other.db";
  EXPECT_EQ(refusal(), path_ +
                           ": cannot use the state: Read-only file system; check the permissions or choose another "
                           "place");
  EXPECT_EQ(kind_, ErrorKind::io);
}

}  // namespace
}  // namespace weir::state_file_test
