#include "daemon/store/job_store.h"

#include <algorithm>
#include <chrono>
#include <csignal>

#include "daemon/store/state_file.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::int64_t kFirstDelay_ms = 5'000;
constexpr std::int64_t kLongestDelay_ms = 600'000;
constexpr int kKilledExit = 128 + SIGKILL;     ///< mostly by the system when it is out of memory
constexpr std::int64_t kClockStep_ms = 1'000;  ///< smaller steps back are ordinary clock corrections
constexpr int kJournalPages = 1000;            ///< 4 MiB
constexpr std::size_t kLogTailBytes = 4096;

/// Resets the columns of attempts and results, for a job that starts anew. Its state is set separately.
constexpr const char* kFresh =
    "attempts = 0, queued_ms = 0, due_ms = 0, started_ms = 0, finished_ms = 0, seconds = 0, bytes_read = 0, "
    "bytes_written = 0, peak_rss_bytes = 0, exit_code = 0, reason = '', problem = '', log_tail = '', forced = 0, "
    "rendering = 0, source_bytes = 0";

/// Makes the jobs that the rest of the statement selects due at once; binds the time.
constexpr const char* kAtOnce =
    "UPDATE jobs SET state = CASE state WHEN 'waiting' THEN 'waiting' ELSE 'discovered' END, due_ms = 0, problem = '', "
    "rendering = 0, changed_ms = ? ";
/// The same, and resets the attempts and the reason.
const std::string kRetried = cat(kAtOnce, ", attempts = 0, reason = '' ");

/// Sets `problem` for the job's new state; binds is_problem() of this state and the reason.
constexpr const char* kProblem = "problem = CASE WHEN ? THEN problem_key(source, ?) ELSE '' END ";

bool is_problem(JobState state) {
  return std::find(kProblemStates.begin(), kProblemStates.end(), state) != kProblemStates.end();
}

// Sets times later than `now` to `now`.
void end_the_future(const Database& database, std::int64_t now) {
  database.prepare("UPDATE jobs SET due_ms = 0 WHERE changed_ms > ?").bind(now).step();
  for (const char* time : {"changed_ms", "discovered_ms", "queued_ms"}) {
    database.prepare(cat("UPDATE jobs SET ", time, " = ? WHERE ", time, " > ?")).bind(now).bind(now).step();
  }
}

std::string tail(const std::string& log) {
  return log.size() <= kLogTailBytes ? log : log.substr(log.size() - kLogTailBytes);
}

}  // namespace

int most_attempts(int exit_code) {
  const bool of_surroundings = exit_code == static_cast<int>(ErrorKind::io) || exit_code == kKilledExit;
  return of_surroundings ? 9 : 5;
}

std::int64_t backoff_ms(int attempts) {
  std::int64_t delay = kFirstDelay_ms;
  for (int i = 1; i < attempts && delay < kLongestDelay_ms; ++i) delay *= 2;
  return std::min(delay, kLongestDelay_ms);
}

std::int64_t JobStore::wall_clock_ms() {
  using std::chrono::milliseconds;
  return std::chrono::duration_cast<milliseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

JobStore::JobStore(const std::string& path, Clock clock) : JobStore(open(path), std::move(clock)) {}

JobStore::Opened JobStore::open(const std::string& path) {
  std::string notice;
  Database database = open_state_file(path, notice);
  return {std::move(database), std::move(notice)};
}

JobStore::JobStore(Opened opened, Clock clock)
    : JobListing(std::move(clock), std::move(opened.database)), notice_(std::move(opened.notice)) {
  end_the_future(database_, now());
  Statement interrupted = database_.prepare(
      cat("UPDATE jobs SET state = 'waiting', changed_ms = ?, due_ms = 0 WHERE ", in_state({JobState::running})));
  interrupted.bind(latest_).step();
}

// If the clock was set back, times later than now are corrected. Otherwise their jobs would count as the newest until
// the clock has caught up.
std::int64_t JobStore::now() {
  const std::int64_t now = clock_();
  if (now < latest_ - kClockStep_ms) end_the_future(database_, now);
  latest_ = now;
  return now;
}

void JobStore::together(const std::function<void()>& steps) {
  Transaction transaction(database_);
  steps();
  transaction.commit();
}

bool JobStore::checkpoint_due() const { return database_.journal_pages() >= kJournalPages; }

JobStore::Observation JobStore::observe(const std::string& watch, const std::string& source,
                                        const FileIdentity& identity, const std::string& options) {
  const std::optional<Job> known = find(watch, source);
  if (known && known->identity == identity && known->options == options) return {Change::none, *known};
  const std::int64_t now = this->now();
  Transaction transaction(database_);
  if (known) {
    Statement update = database_.prepare(
        cat("UPDATE jobs SET bytes = ?, mtime_ns = ?, inode = ?, options = ?, discovered_ms = ?, changed_ms = ?, "
            "state = 'discovered', ",
            kFresh, " WHERE id = ?"));
    update.bind(identity.bytes).bind(identity.mtime_ns).bind(identity.inode).bind(options).bind(now).bind(now);
    update.bind(known->id).step();
    database_.prepare("DELETE FROM outputs WHERE job = ?").bind(known->id).step();
  } else {
    Statement insert = database_.prepare(
        "INSERT INTO jobs (watch, source, options, bytes, mtime_ns, inode, state, discovered_ms, changed_ms) "
        "VALUES (?, ?, ?, ?, ?, ?, 'discovered', ?, ?)");
    insert.bind(watch).bind(source).bind(options).bind(identity.bytes).bind(identity.mtime_ns).bind(identity.inode);
    insert.bind(now).bind(now).step();
  }
  transaction.commit();
  return {known ? Change::changed : Change::created, find(watch, source).value()};
}

bool JobStore::enqueue(std::int64_t id) {
  const std::int64_t now = this->now();
  database_
      .prepare(cat("UPDATE jobs SET state = 'waiting', changed_ms = ?, queued_ms = ?, due_ms = 0, reason = '' "
                   "WHERE id = ? AND ",
                   in_state({JobState::discovered})))
      .bind(now)
      .bind(now)
      .bind(id)
      .step();
  return database_.changes() == 1;
}

bool JobStore::start(std::int64_t id) {
  const std::int64_t now = this->now();
  database_
      .prepare(cat("UPDATE jobs SET state = 'running', changed_ms = ?, started_ms = ?, reason = '' WHERE id = ? AND ",
                   in_state({JobState::waiting})))
      .bind(now)
      .bind(now)
      .bind(id)
      .step();
  return database_.changes() == 1;
}

bool JobStore::end_attempt(std::int64_t id, const JobResult& result, JobState to, int attempts, std::int64_t delay_ms) {
  const std::int64_t now = this->now();
  Transaction transaction(database_);
  Statement update = database_.prepare(
      cat("UPDATE jobs SET state = ?, changed_ms = ?, finished_ms = ?, attempts = ?, due_ms = ?, seconds = ?, "
          "bytes_read = ?, bytes_written = ?, peak_rss_bytes = ?, exit_code = ?, reason = ?, log_tail = ?, "
          "source_bytes = ?, forced = forced AND ?, ",
          kProblem, "WHERE id = ? AND ", in_state({JobState::running})));
  update.bind(job_state_name(to)).bind(now).bind(now).bind(attempts).bind(delay_ms == 0 ? 0 : now + delay_ms);
  update.bind(result.seconds).bind(result.bytes_read).bind(result.bytes_written).bind(result.peak_rss_bytes);
  update.bind(result.exit_code).bind(result.reason).bind(tail(result.log_tail));
  update.bind(result.source_bytes).bind(to != JobState::done);
  update.bind(is_problem(to)).bind(result.reason).bind(id).step();
  if (database_.changes() == 0) return false;
  database_.prepare("DELETE FROM outputs WHERE job = ?").bind(id).step();
  for (std::size_t i = 0; i < result.outputs.size(); ++i) {
    const JobOutput& output = result.outputs[i];
    Statement insert = database_.prepare("INSERT INTO outputs VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(id).bind(std::uint64_t{i}).bind(output.path).bind(output.bytes).bind(output.rate);
    insert.bind(output.psnr_db).bind(output.thumbnail);
    insert.bind(output.max_error).bind(output.min).bind(output.max).step();
  }
  transaction.commit();
  return true;
}

bool JobStore::finish(std::int64_t id, const JobResult& result, bool rendering) {
  Transaction transaction(database_);
  const std::optional<Job> known = job(id);
  if (!known || !end_attempt(id, result, JobState::done, known->attempts, 0)) return false;
  database_.prepare("UPDATE jobs SET rendering = ? WHERE id = ?").bind(rendering).bind(id).step();
  transaction.commit();
  return true;
}

bool JobStore::finish_rendering(std::int64_t id, const std::vector<JobOutput>& outputs) {
  Transaction transaction(database_);
  database_
      .prepare(cat("UPDATE jobs SET rendering = 0, changed_ms = ? WHERE id = ? AND rendering = 1 AND ",
                   in_state({JobState::done})))
      .bind(now())
      .bind(id)
      .step();
  if (database_.changes() == 0) return false;
  for (const JobOutput& output : outputs) {
    database_.prepare("UPDATE outputs SET thumbnail = ? WHERE job = ? AND path = ?")
        .bind(output.thumbnail)
        .bind(id)
        .bind(output.path)
        .step();
  }
  transaction.commit();
  return true;
}

JobState JobStore::state_after(int exit_code, int attempts) {
  const auto is = [&](ErrorKind kind) { return exit_code == static_cast<int>(kind); };
  if (is(ErrorKind::input)) return JobState::quarantined;
  const bool over = is(ErrorKind::usage) || is(ErrorKind::budget) || attempts >= most_attempts(exit_code);
  return over ? JobState::failed : JobState::waiting;
}

bool JobStore::fail(std::int64_t id, const JobResult& result) {
  const std::optional<Job> known = job(id);
  if (!known) return false;
  const int attempts = known->attempts + 1;
  const JobState state = state_after(result.exit_code, attempts);
  return end_attempt(id, result, state, attempts, state == JobState::waiting ? backoff_ms(attempts) : 0);
}

bool JobStore::move(std::int64_t id, std::initializer_list<JobState> from, JobState to, const std::string& reason) {
  Statement update = database_.prepare(
      cat("UPDATE jobs SET state = ?, changed_ms = ?, due_ms = 0, forced = forced AND ?, reason = ?, ", kProblem,
          "WHERE id = ? AND ", in_state(from)));
  update.bind(job_state_name(to)).bind(now()).bind(to != JobState::cancelled).bind(reason);
  update.bind(is_problem(to)).bind(reason).bind(id).step();
  return database_.changes() == 1;
}

bool JobStore::postpone(std::int64_t id, const std::string& reason, std::int64_t delay_ms) {
  Transaction transaction(database_);
  if (!move(id, {JobState::running}, JobState::waiting, reason)) return false;
  if (delay_ms > 0) {
    database_.prepare("UPDATE jobs SET due_ms = ? WHERE id = ?").bind(now() + delay_ms).bind(id).step();
  }
  transaction.commit();
  return true;
}

bool JobStore::quarantine(std::int64_t id, const std::string& reason) {
  return move(id, {JobState::discovered, JobState::waiting, JobState::running}, JobState::quarantined, reason);
}

bool JobStore::retry_problem(std::int64_t id) {
  database_.prepare(cat(kRetried, "WHERE id = ? AND ", in_state(kProblemStates))).bind(now()).bind(id).step();
  return database_.changes() == 1;
}

bool JobStore::hasten(std::int64_t id) {
  database_
      .prepare(cat(kAtOnce, "WHERE id = ? AND exit_code = ? AND (", in_state({JobState::failed}),
                   " OR (state = 'waiting' AND due_ms != 0))"))
      .bind(now())
      .bind(id)
      .bind(static_cast<std::int64_t>(ErrorKind::io))
      .step();
  return database_.changes() == 1;
}

bool JobStore::cancel(std::int64_t id) {
  return move(id, {JobState::discovered, JobState::waiting, JobState::running}, JobState::cancelled, "cancelled");
}

bool JobStore::retry(std::int64_t id, bool force) {
  Transaction transaction(database_);
  database_
      .prepare(cat(kRetried, "WHERE id = ? AND (",
                   in_state({JobState::done, JobState::failed, JobState::quarantined, JobState::cancelled}),
                   " OR (state = 'waiting' AND due_ms != 0))"))
      .bind(now())
      .bind(id)
      .step();
  const bool retried = database_.changes() == 1;
  if (retried && force) database_.prepare("UPDATE jobs SET forced = 1 WHERE id = ?").bind(id).step();
  transaction.commit();
  return retried;
}

void JobStore::retry_failed_io() {
  database_.prepare(cat(kRetried, "WHERE ", in_state({JobState::failed}), " AND exit_code = ?"))
      .bind(now())
      .bind(static_cast<std::int64_t>(ErrorKind::io))
      .step();
}

bool JobStore::remove(std::int64_t id) {
  Transaction transaction(database_);
  database_.prepare("DELETE FROM jobs WHERE id = ? AND state != 'running'").bind(id).step();
  const bool removed = database_.changes() == 1;
  if (removed) database_.prepare("DELETE FROM outputs WHERE job = ?").bind(id).step();
  transaction.commit();
  return removed;
}

void JobStore::forget_other_watches(const std::vector<Watched>& watches) {
  Transaction transaction(database_);
  // A condition with one term per watch is too deep for SQLite from a thousand terms on.
  database_.run("CREATE TEMPORARY TABLE kept (watch TEXT, below TEXT, PRIMARY KEY (watch, below)) WITHOUT ROWID");
  for (const Watched& watch : watches) {
    const std::string below = watch.directory.ends_with('/') ? watch.directory : watch.directory + '/';
    database_.prepare("INSERT OR IGNORE INTO kept VALUES (?, ?)").bind(watch.label).bind(below).step();
  }
  database_
      .prepare(cat("DELETE FROM jobs WHERE ", in_state(kForgottenStates),
                   " AND NOT EXISTS (SELECT 1 FROM kept WHERE kept.watch = jobs.watch"
                   " AND substr(jobs.source, 1, length(kept.below)) = kept.below)"))
      .step();
  if (database_.changes() > 0) database_.prepare("DELETE FROM outputs WHERE job NOT IN (SELECT id FROM jobs)").step();
  database_.run("DROP TABLE kept");
  transaction.commit();
}

}  // namespace weir
