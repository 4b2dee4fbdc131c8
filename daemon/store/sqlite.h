// SQLite behind values that close themselves. Errors are weir's: one line with
// the file, what was done, SQLite's reason.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "format/base/error.h"

namespace weir {

/// A failure that says the file's content is damaged or no database.
class CorruptDatabase : public Error {
 public:
  using Error::Error;
};

/// What a Database and its statements share: the connection, and statements that wait to be used again, because to
/// prepare one takes longer than most take to run.
struct Connection {
  struct Close {
    void operator()(sqlite3* open) const { sqlite3_close_v2(open); }
  };
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  using Prepared = std::unique_ptr<sqlite3_stmt, Finalize>;

  std::string path;
  std::unique_ptr<sqlite3, Close> database;
  int journal_pages = 0;                                   ///< of the write-ahead journal, after the last commit
  std::multimap<std::string, Prepared, std::less<>> idle;  ///< by their SQL
};

/// One run of a prepared statement: bind the parameters in order, then step through the rows. Must not outlive its
/// database.
class Statement {
 public:
  Statement(Connection& connection, std::string_view sql);
  ~Statement();
  Statement(Statement&&) noexcept = default;
  Statement& operator=(Statement&&) = delete;

  Statement& bind(std::int64_t value);
  Statement& bind(int value) { return bind(std::int64_t{value}); }
  Statement& bind(std::uint64_t value) { return bind(static_cast<std::int64_t>(value)); }  ///< two's complement
  Statement& bind(double value);
  Statement& bind(std::string_view value);
  Statement& bind(const std::optional<double>& value);  ///< absent: NULL

  /// Whether there is a (further) row.
  bool step();

  bool is_null(int column) const;
  std::int64_t integer(int column) const;
  std::uint64_t whole(int column) const { return static_cast<std::uint64_t>(integer(column)); }
  double real(int column) const;
  std::optional<double> real_or_none(int column) const;  ///< none: NULL
  std::string text(int column) const;

 private:
  void check(int status) const;

  Connection* connection_;
  Connection::Prepared statement_;
  int bound_ = 0;
};

class Database {
 public:
  /// Opens or makes the file. Throws Error(io); CorruptDatabase appears with the first statement.
  explicit Database(const std::string& path);

  Statement prepare(std::string_view sql) const { return {*connection_, sql}; }
  /// Runs a statement without parameters to its end.
  void run(std::string_view sql) const;
  /// From now on SQL may call NAME(a, b) of two texts: what `function`, which must not throw but for want of memory,
  /// says of them.
  void add_function(const char* name, std::string (*function)(std::string_view, std::string_view));
  /// Rows changed by the last statement.
  int changes() const { return sqlite3_changes(connection_->database.get()); }
  /// Pages in the write-ahead journal after the last commit. Commits copy them to the database by themselves only where
  /// they are many; until then it is checkpoint() that does, because that takes flushes of the disk of its own.
  int journal_pages() const { return connection_->journal_pages; }
  void checkpoint();
  /// Whether a transaction is open.
  bool in_transaction() const { return sqlite3_get_autocommit(connection_->database.get()) == 0; }

 private:
  std::unique_ptr<Connection> connection_;  ///< at an address that statements may keep
};

/// All statements between its making and commit(), or none. Transactions may be nested: the inner one takes back
/// its own statements, the outermost one writes to disk.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool committed_ = false;
};

}  // namespace weir
