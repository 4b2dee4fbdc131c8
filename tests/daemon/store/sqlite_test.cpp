#include "daemon/store/sqlite.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "tests/support/temporary_directory.h"

namespace weir::sqlite_test {
namespace {

std::int64_t count(const Database& database) {
  Statement row = database.prepare("SELECT count(*) FROM t");
  row.step();
  return row.integer(0);
}

class Sqlite : public testing::Test {
 protected:
  TemporaryDirectory directory_;
  std::string path_ = directory_ / "t.db";
};

TEST_F(Sqlite, BoundValuesAreReadBackUnchanged) {
  const Database database(path_);
  database.run("CREATE TABLE t (a, b, c, d, e, f)");
  Statement insert = database.prepare("INSERT INTO t VALUES (?, ?, ?, ?, ?, ?)");
  const std::string latin1("\xe9 \x01 ' \"", 7);
  insert.bind(std::numeric_limits<std::int64_t>::min()).bind(std::numeric_limits<std::uint64_t>::max()).bind(0.1);
  insert.bind(latin1).bind(std::string_view()).bind(std::optional<double>()).step();
  Statement row = database.prepare("SELECT * FROM t");
  ASSERT_TRUE(row.step());
  EXPECT_EQ(row.integer(0), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(row.whole(1), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(row.real(2), 0.1);
  EXPECT_EQ(row.text(3), latin1);
  EXPECT_EQ(row.text(4), "");
  EXPECT_FALSE(row.is_null(4));
  EXPECT_TRUE(row.is_null(5));
  EXPECT_FALSE(row.step());
}

TEST_F(Sqlite, ReusedStatement_HasNoOldBindings) {
  const Database database(path_);
  database.run("CREATE TABLE t (a)");
  const char* insert = "INSERT INTO t VALUES (?)";
  database.prepare(insert).bind(7).step();
  database.prepare(insert).step();
  const char* select = "SELECT a FROM t ORDER BY rowid";
  Statement outer = database.prepare(select);
  ASSERT_TRUE(outer.step());
  {
    Statement inner = database.prepare(select);  // while a statement with the same text runs
    ASSERT_TRUE(inner.step());
    EXPECT_EQ(inner.integer(0), 7);
  }
  Statement again = database.prepare(select);
  ASSERT_TRUE(again.step()) << "it starts at the first row";
  EXPECT_EQ(again.integer(0), 7);
  ASSERT_TRUE(outer.step());
  EXPECT_TRUE(outer.is_null(0));
}

TEST_F(Sqlite, ATransactionThatIsNotCommittedLeavesNothing) {
  Database database(path_);
  database.run("CREATE TABLE t (a)");
  {
    const Transaction abandoned(database);
    database.run("INSERT INTO t VALUES (1)");
    EXPECT_TRUE(database.in_transaction());
  }
  EXPECT_FALSE(database.in_transaction());
  EXPECT_EQ(count(database), 0);
}

TEST_F(Sqlite, AbandonedInnerTransaction_RollsBackItsOwnStatementsOnly) {
  Database database(path_);
  database.run("CREATE TABLE t (a)");
  Transaction outer(database);
  database.run("INSERT INTO t VALUES (1)");
  {
    const Transaction abandoned(database);
    database.run("INSERT INTO t VALUES (2)");
  }
  {
    Transaction kept(database);
    database.run("INSERT INTO t VALUES (3)");
    kept.commit();
  }
  outer.commit();
  Statement sum = database.prepare("SELECT sum(a) FROM t");
  sum.step();
  EXPECT_EQ(sum.integer(0), 4);
}

TEST_F(Sqlite, JournalIsCopiedByCheckpointAndNotByCommits) {
  Database database(path_);
  database.run("PRAGMA journal_mode=WAL");
  database.run("CREATE TABLE t (a)");
  const auto empty = std::filesystem::file_size(path_);
  const std::string page(4000, 'x');
  for (int i = 0; i < 1500; ++i) database.prepare("INSERT INTO t VALUES (?)").bind(page).step();
  EXPECT_GE(database.journal_pages(), 1500);
  EXPECT_EQ(std::filesystem::file_size(path_), empty);
  database.checkpoint();
  EXPECT_EQ(database.journal_pages(), 0);
  EXPECT_GE(std::filesystem::file_size(path_), 1500 * page.size());
  database.run("INSERT INTO t VALUES (1)");
  EXPECT_LT(database.journal_pages(), 10);
}

TEST_F(Sqlite, ErrorsNameTheFileAndTheReason) {
  try {
    const Database database(directory_ / "missing/t.db");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), (directory_ / "missing/t.db") + ": cannot use the state: No such file or directory");
    EXPECT_EQ(error.kind(), ErrorKind::io);
  }
  const Database database(path_);
  try {
    database.run("SELECT * FROM t");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), path_ + ": cannot use the state: no such table: t");
  }
  database.run("CREATE TABLE t (a UNIQUE)");
  database.run("INSERT INTO t VALUES (1)");
  try {
    database.run("INSERT INTO t VALUES (1)");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), path_ + ": cannot use the state: UNIQUE constraint failed: t.a");
  }
}

}  // namespace
}  // namespace weir::sqlite_test
