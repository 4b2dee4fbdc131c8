#include "daemon/store/state_file.h"

#include <filesystem>

#include "daemon/store/problem_key.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr const char* kTables[] = {
    // One row for each source of each watch; names and units as in struct Job.
    R"(CREATE TABLE jobs (
         id INTEGER PRIMARY KEY AUTOINCREMENT,
         watch TEXT NOT NULL,
         source TEXT NOT NULL,
         options TEXT NOT NULL,
         bytes INTEGER NOT NULL,
         mtime_ns INTEGER NOT NULL,
         inode INTEGER NOT NULL,
         state TEXT NOT NULL CHECK (state IN ('discovered', 'waiting', 'running', 'done', 'failed', 'quarantined',
                                              'cancelled')),
         attempts INTEGER NOT NULL DEFAULT 0,
         discovered_ms INTEGER NOT NULL,
         changed_ms INTEGER NOT NULL,
         queued_ms INTEGER NOT NULL DEFAULT 0,
         due_ms INTEGER NOT NULL DEFAULT 0,
         started_ms INTEGER NOT NULL DEFAULT 0,
         finished_ms INTEGER NOT NULL DEFAULT 0,
         seconds REAL NOT NULL DEFAULT 0,
         bytes_read INTEGER NOT NULL DEFAULT 0,
         bytes_written INTEGER NOT NULL DEFAULT 0,
         peak_rss_bytes INTEGER NOT NULL DEFAULT 0,
         exit_code INTEGER NOT NULL DEFAULT 0,
         reason TEXT NOT NULL DEFAULT '',
         log_tail TEXT NOT NULL DEFAULT '',
         forced INTEGER NOT NULL DEFAULT 0,
         problem TEXT NOT NULL DEFAULT '',
         rendering INTEGER NOT NULL DEFAULT 0,
         source_bytes INTEGER NOT NULL DEFAULT 0,
         UNIQUE (watch, source)) STRICT)",
    // Indexes for the scheduler and /metrics.
    "CREATE INDEX jobs_queue ON jobs (watch, state, mtime_ns)",
    "CREATE INDEX jobs_age ON jobs (queued_ms) WHERE state = 'waiting'",
    "CREATE INDEX jobs_due ON jobs (due_ms) WHERE state = 'waiting'",
    // Indexes for the lists that people ask for.
    "CREATE INDEX jobs_waiting ON jobs (watch, bytes) WHERE state = 'waiting'",
    "CREATE INDEX jobs_problem ON jobs (problem, changed_ms) WHERE problem != ''",
    "CREATE INDEX jobs_latest ON jobs (changed_ms)", "CREATE INDEX jobs_latest_of_state ON jobs (state, changed_ms)",
    R"(CREATE TABLE outputs (
         job INTEGER NOT NULL,
         place INTEGER NOT NULL,
         path TEXT NOT NULL,
         bytes INTEGER NOT NULL,
         rate REAL NOT NULL,
         psnr_db REAL,
         thumbnail TEXT NOT NULL,
         max_error REAL,
         min REAL,
         max REAL,
         PRIMARY KEY (job, place)) STRICT, WITHOUT ROWID)"};

/// Changes that turn a file of version 1 into one of version 2; the next arrays do the same for later versions.
constexpr const char* kFromVersion1[] = {
    "ALTER TABLE jobs ADD COLUMN forced INTEGER NOT NULL DEFAULT 0",
    "ALTER TABLE jobs ADD COLUMN problem TEXT NOT NULL DEFAULT ''",
    "UPDATE jobs SET problem = problem_key(source, reason) WHERE state IN ('failed', 'quarantined')",
    "CREATE INDEX jobs_waiting ON jobs (watch, bytes) WHERE state = 'waiting'",
    "CREATE INDEX jobs_problem ON jobs (problem, changed_ms) WHERE problem != ''",
    "ALTER TABLE outputs ADD COLUMN max_error REAL",
    "ALTER TABLE outputs ADD COLUMN min REAL",
    "ALTER TABLE outputs ADD COLUMN max REAL"};

constexpr const char* kFromVersion2[] = {"ALTER TABLE jobs ADD COLUMN rendering INTEGER NOT NULL DEFAULT 0"};

// The text leaves out options that do not change an output's bytes: done jobs stay done.
constexpr const char* kFromVersion3[] = {
    "UPDATE jobs SET options = replace(replace(replace(options, ' --direct-io=auto', ''), ' --direct-io=on', ''), "
    "' --direct-io=off', '') WHERE instr(options, ' --direct-io=') > 0"};

constexpr const char* kFromVersion4[] = {"ALTER TABLE jobs ADD COLUMN source_bytes INTEGER NOT NULL DEFAULT 0"};

std::int64_t number(const Database& database, const char* sql) {
  Statement statement = database.prepare(sql);
  statement.step();
  return statement.integer(0);
}

void check_whole(const Database& database, const std::string& path) {
  Statement check = database.prepare("PRAGMA quick_check(1)");
  if (check.step() && check.text(0) != "ok") {
    throw CorruptDatabase(ErrorKind::io, cat(path, ": damaged: ", check.text(0)));
  }
}

void check_ours(const Database& database, const std::string& path) {
  const std::int64_t application = number(database, "PRAGMA application_id");
  const bool foreign =
      application == 0 ? number(database, "SELECT count(*) FROM sqlite_schema") != 0 : application != kStateApplication;
  if (foreign) {
    throw Error(ErrorKind::input,
                cat(path, ": is a database of another program; name another file as state in [service]"));
  }
  const std::int64_t version = number(database, "PRAGMA user_version");
  if (version > kStateVersion) throw newer_state(path, version);
}

Database open_whole(const std::string& path) {
  Database database(path);
  // The lock is held until the file is closed. So a second daemon is refused, and WAL needs no memory shared between
  // processes, which network file systems do not have.
  database.run("PRAGMA locking_mode=EXCLUSIVE");
  check_ours(database, path);  // before anything is written
  database.run("PRAGMA journal_mode=WAL");
  database.run("PRAGMA synchronous=FULL");
  database.run("PRAGMA journal_size_limit=16777216");
  check_whole(database, path);
  database.add_function("problem_key", problem_key);
  Transaction made(database);
  const std::int64_t version = number(database, "PRAGMA user_version");
  if (version == 0) {
    for (const char* table : kTables) database.run(table);
    database.run(cat("PRAGMA application_id=", kStateApplication));
  } else {
    if (version == 1) {
      for (const char* change : kFromVersion1) database.run(change);
    }
    if (version <= 2) {
      for (const char* change : kFromVersion2) database.run(change);
    }
    if (version <= 3) {
      for (const char* change : kFromVersion3) database.run(change);
    }
    if (version <= 4) {
      for (const char* change : kFromVersion4) database.run(change);
    }
  }
  if (version != kStateVersion) database.run(cat("PRAGMA user_version=", kStateVersion));
  made.commit();
  return database;
}

/// Moves the file to the first free PATH.corrupt-N and returns that name.
std::string move_aside(const std::string& path) {
  std::string aside;
  for (int n = 1; aside.empty() || std::filesystem::exists(aside); ++n) aside = cat(path, ".corrupt-", n);
  std::error_code error;
  std::filesystem::rename(path, aside, error);
  if (error) throw io_error(path, cat("move the damaged state to ", aside), error.value());
  for (const char* journal :
       {"-wal", "-shm", "-journal"}) {  // the journals rarely exist, and are of no use to the new file
    std::filesystem::rename(path + journal, aside + journal, error);
  }
  return aside;
}

}  // namespace

Database open_state_file(const std::string& path, std::string& notice) {
  refuse_foreign_state(path);  // checked before SQLite may remove the file's journal
  try {
    return open_whole(path);
  } catch (const CorruptDatabase& damage) {
    const std::string aside = move_aside(path);
    notice = cat(damage.what(), "; moved to ", aside, ", jobs are found anew");
  }
  return open_whole(path);
}

}  // namespace weir
