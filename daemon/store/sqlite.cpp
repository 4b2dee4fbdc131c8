#include "daemon/store/sqlite.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "format/base/text.h"

namespace weir {
namespace {

constexpr int kMostJournalPages = 16'384;  // 64 MiB; reached only if checkpoint() was not called for long
constexpr int kBusyTimeout_ms = 1000;      // a daemon that was just killed may still be ending

const char* remedy(int status) {
  switch (status) {
    case SQLITE_BUSY:
      return "; another process has it open, and only one weir watch may use a state file";
    case SQLITE_FULL:
      return "; make room";
    case SQLITE_READONLY:
      return "; make the file and its directory writable";
    default:
      return "";
  }
}

int after_commit(void* pages_of_connection, sqlite3* database, const char* /*schema*/, int pages) {
  *static_cast<int*>(pages_of_connection) = pages;
  // The commit itself is done. A fault of this checkpoint is reported by the next one.
  if (pages >= kMostJournalPages)
    sqlite3_wal_checkpoint_v2(database, nullptr, SQLITE_CHECKPOINT_PASSIVE, nullptr, nullptr);
  return SQLITE_OK;
}

[[noreturn]] void fail(const Connection& connection, int status) {
  const int primary = status & 0xff;  // the other bits are SQLite's extended code
  const std::string message =
      cat(connection.path, ": cannot use the state: ", sqlite3_errmsg(connection.database.get()), remedy(primary));
  if (primary == SQLITE_CORRUPT || primary == SQLITE_NOTADB) throw CorruptDatabase(ErrorKind::io, message);
  throw Error(ErrorKind::io, message);
}

}  // namespace

Statement::Statement(Connection& connection, std::string_view sql) : connection_(&connection) {
  const auto idle = connection.idle.find(sql);
  if (idle != connection.idle.end()) {
    statement_ = std::move(connection.idle.extract(idle).mapped());
    return;
  }
  sqlite3_stmt* statement = nullptr;
  const int status =
      sqlite3_prepare_v2(connection.database.get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr);
  statement_.reset(statement);
  if (status != SQLITE_OK) fail(connection, status);
}

Statement::~Statement() {
  if (!statement_) return;
  sqlite3_reset(statement_.get());  // returns the error that step() has thrown already
  sqlite3_clear_bindings(statement_.get());
  const char* sql = sqlite3_sql(statement_.get());
  connection_->idle.emplace(sql, std::move(statement_));
}

void Statement::check(int status) const {
  if (status != SQLITE_OK) fail(*connection_, status);
}

Statement& Statement::bind(std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), ++bound_, value));
  return *this;
}

Statement& Statement::bind(double value) {
  check(sqlite3_bind_double(statement_.get(), ++bound_, value));
  return *this;
}

Statement& Statement::bind(std::string_view value) {
  // An empty view may hold a null pointer, which SQLite takes for NULL.
  const char* text = value.empty() ? "" : value.data();
  check(sqlite3_bind_text(statement_.get(), ++bound_, text, static_cast<int>(value.size()), SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind(const std::optional<double>& value) {
  if (value) return bind(*value);
  check(sqlite3_bind_null(statement_.get(), ++bound_));
  return *this;
}

bool Statement::step() {
  const int status = sqlite3_step(statement_.get());
  if (status == SQLITE_ROW) return true;
  if (status == SQLITE_DONE) return false;
  fail(*connection_, status);
}

bool Statement::is_null(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::optional<double> Statement::real_or_none(int column) const {
  return is_null(column) ? std::nullopt : std::optional(real(column));
}

std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  if (text == nullptr) return {};
  return {text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

Database::Database(const std::string& path) : connection_(std::make_unique<Connection>()) {
  connection_->path = path;
  sqlite3* database = nullptr;
  const int status = sqlite3_open_v2(path.c_str(), &database,
                                     SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
  connection_->database.reset(database);
  if (database == nullptr) throw Error(ErrorKind::io, cat(path, ": cannot use the state: out of memory"));
  if (status != SQLITE_OK) {
    // SQLite reports only the failure of its last try, which is to open for reading.
    const int again = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (again < 0) throw io_error(path, "use the state", errno);
    close(again);
    fail(*connection_, status);
  }
  // SQLite opens a file for reading if it may not write to it.
  if (sqlite3_db_readonly(database, "main") == 1) {
    throw Error(ErrorKind::io, cat(path, ": cannot use the state: it is read-only", remedy(SQLITE_READONLY)));
  }
  sqlite3_busy_timeout(database, kBusyTimeout_ms);
  sqlite3_wal_hook(database, after_commit, &connection_->journal_pages);
}

void Database::add_function(const char* name, std::string (*function)(std::string_view, std::string_view)) {
  const auto call = [](sqlite3_context* context, int /*count*/, sqlite3_value** values) {
    const auto text_of = [](sqlite3_value* value) {
      const auto* text = reinterpret_cast<const char*>(sqlite3_value_text(value));
      return text == nullptr ? std::string_view()
                             : std::string_view(text, static_cast<std::size_t>(sqlite3_value_bytes(value)));
    };
    const auto called =
        reinterpret_cast<std::string (*)(std::string_view, std::string_view)>(sqlite3_user_data(context));
    try {
      const std::string result = called(text_of(values[0]), text_of(values[1]));
      sqlite3_result_text64(context, result.data(), result.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    } catch (const std::bad_alloc&) {
      sqlite3_result_error_nomem(context);
    }
  };
  const int status =
      sqlite3_create_function_v2(connection_->database.get(), name, 2, SQLITE_UTF8 | SQLITE_DETERMINISTIC,
                                 reinterpret_cast<void*>(function), call, nullptr, nullptr, nullptr);
  if (status != SQLITE_OK) fail(*connection_, status);
}

void Database::run(std::string_view sql) const {
  Statement statement = prepare(sql);
  while (statement.step()) {
  }
}

void Database::checkpoint() {
  const int status =
      sqlite3_wal_checkpoint_v2(connection_->database.get(), nullptr, SQLITE_CHECKPOINT_PASSIVE, nullptr, nullptr);
  if (status != SQLITE_OK) fail(*connection_, status);
  connection_->journal_pages = 0;
}

Transaction::Transaction(Database& database) : database_(database) { database_.run("SAVEPOINT weir"); }

Transaction::~Transaction() {
  // After some failures, for example a full disk, SQLite has rolled back by itself.
  if (committed_ || !database_.in_transaction()) return;
  try {
    database_.run("ROLLBACK TO weir");
    database_.run("RELEASE weir");
  } catch (const Error&) {
    // Nothing was committed, and the first failure is being reported.
  }
}

void Transaction::commit() {
  database_.run("RELEASE weir");
  committed_ = true;
}

}  // namespace weir
