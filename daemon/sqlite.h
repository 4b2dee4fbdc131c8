// SQLite behind values that close themselves. Errors are weir's: one line with
// the file, what was done, SQLite's reason.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "format/error.h"

namespace weir {

/// A failure that says the file's content is damaged or no database.
class CorruptDatabase : public Error {
 public:
  using Error::Error;
};

/// One prepared statement, run once: bind the parameters in order, then step through rows.
class Statement {
 public:
  Statement(sqlite3* database, const std::string& path, std::string_view sql);

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
  std::string text(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  void check(int status) const;

  sqlite3* database_;
  const std::string* path_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int bound_ = 0;
};

class Database {
 public:
  /// Opens or makes the file. Throws Error(io); CorruptDatabase appears with the first statement.
  explicit Database(const std::string& path);

  Statement prepare(std::string_view sql) const { return {database_.get(), *path_, sql}; }
  /// Runs a statement without parameters to its end.
  void run(std::string_view sql) const;
  /// Rows changed by the last statement.
  int changes() const { return sqlite3_changes(database_.get()); }
  std::int64_t last_id() const { return sqlite3_last_insert_rowid(database_.get()); }
  /// Whether a transaction is open.
  bool in_transaction() const { return sqlite3_get_autocommit(database_.get()) == 0; }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  std::unique_ptr<const std::string> path_;  ///< at an address that statements may keep
  std::unique_ptr<sqlite3, Close> database_;
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
