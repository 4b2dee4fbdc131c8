// SQLite behind objects that close themselves. Errors are weir's: one line with the file, the action and SQLite's
// reason.
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

/// An error that says that the file is damaged or no database.
class CorruptDatabase : public Error {
 public:
  using Error::Error;
};

/// The state that a Database and its statements share: the connection, and idle statements for later use, because
/// preparing a statement takes longer than running most of them.
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
  int journal_pages = 0;                                   ///< pages of the write-ahead journal after the last commit
  std::multimap<std::string, Prepared, std::less<>> idle;  ///< by SQL text
};

/// One run of a prepared statement: bind the parameters in order, then step through the rows. Must not outlive the
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

  /// Moves to the next row. Returns whether there is one.
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
  /// Opens or creates the file. Throws Error(io). A damaged file is noticed by a statement at the earliest.
  explicit Database(const std::string& path);

  Statement prepare(std::string_view sql) const { return {*connection_, sql}; }
  /// Runs a statement without parameters to its end.
  void run(std::string_view sql) const;
  /// Lets SQL call NAME(a, b) with two texts from now on; the result is that of `function`, which may throw only
  /// std::bad_alloc.
  void add_function(const char* name, std::string (*function)(std::string_view, std::string_view));
  /// Returns the number of rows that the last statement changed.
  int changes() const { return sqlite3_changes(connection_->database.get()); }
  /// Returns the pages in the write-ahead journal after the last commit. A commit copies them to the database only if
  /// there are very many. Otherwise checkpoint() does it, because this takes disk flushes of its own.
  int journal_pages() const { return connection_->journal_pages; }
  void checkpoint();
  /// Returns whether a transaction is open.
  bool in_transaction() const { return sqlite3_get_autocommit(connection_->database.get()) == 0; }

 private:
  std::unique_ptr<Connection> connection_;  ///< on the heap, because statements keep its address
};

/// Commits all statements between its construction and commit(), or none of them. Transactions may be nested: an
/// inner one undoes its own statements, and the outermost one writes to disk.
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
