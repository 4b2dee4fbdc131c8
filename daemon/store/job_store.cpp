#include "daemon/store/job_store.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "daemon/store/state_file.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::int64_t kFirstDelay_ms = 5'000;
constexpr std::int64_t kLongestDelay_ms = 600'000;
constexpr std::int64_t kClockStep_ms = 1'000;  ///< smaller steps back are the clock's being kept right
constexpr int kJournalPages = 1000;            ///< 4 MiB
constexpr std::size_t kLogTailBytes = 4096;

constexpr std::initializer_list<JobState> kProblemStates{JobState::failed, JobState::quarantined};

constexpr const char* kColumns =
    "SELECT id, watch, source, options, bytes, mtime_ns, inode, state, attempts, discovered_ms, changed_ms, queued_ms, "
    "due_ms, started_ms, finished_ms, seconds, bytes_read, bytes_written, peak_rss_bytes, exit_code, reason, log_tail, "
    "forced "
    "FROM jobs ";

/// What a job starts anew with, besides its state.
constexpr const char* kFresh =
    "attempts = 0, queued_ms = 0, due_ms = 0, started_ms = 0, finished_ms = 0, seconds = 0, bytes_read = 0, "
    "bytes_written = 0, peak_rss_bytes = 0, exit_code = 0, reason = '', problem = '', log_tail = '', forced = 0";

/// Has the jobs that follow it their turn at once; binds the time.
constexpr const char* kAtOnce =
    "UPDATE jobs SET state = CASE state WHEN 'waiting' THEN 'waiting' ELSE 'discovered' END, due_ms = 0, problem = '', "
    "changed_ms = ? ";
/// The same, and what went before counts no more.
const std::string kRetried = cat(kAtOnce, ", attempts = 0, reason = '' ");

/// What the state that a job comes to makes of its problem; binds is_problem() of that state and the reason.
constexpr const char* kProblem = "problem = CASE WHEN ? THEN problem_key(source, ?) ELSE '' END ";

std::vector<JobOutput> read_outputs(const Database& database, std::int64_t job) {
  Statement rows = database.prepare(
      "SELECT path, bytes, rate, psnr_db, thumbnail, max_error, min, max FROM outputs WHERE job = ? ORDER BY place");
  rows.bind(job);
  std::vector<JobOutput> outputs;
  while (rows.step()) {
    JobOutput& output = outputs.emplace_back();
    output.path = rows.text(0);
    output.bytes = rows.whole(1);
    output.rate = rows.real(2);
    output.psnr_db = rows.real_or_none(3);
    output.thumbnail = rows.text(4);
    output.max_error = rows.real_or_none(5);
    output.min = rows.real_or_none(6);
    output.max = rows.real_or_none(7);
  }
  return outputs;
}

Job read_job(const Database& database, const Statement& row) {
  int column = 0;
  Job job;
  job.id = row.integer(column++);
  job.watch = row.text(column++);
  job.source = row.text(column++);
  job.options = row.text(column++);
  job.identity.bytes = row.whole(column++);
  job.identity.mtime_ns = row.integer(column++);
  job.identity.inode = row.whole(column++);
  job.state = parse_job_state(row.text(column++)).value();  // the table allows no other
  job.attempts = static_cast<int>(row.integer(column++));
  job.discovered_ms = row.integer(column++);
  job.changed_ms = row.integer(column++);
  job.queued_ms = row.integer(column++);
  job.due_ms = row.integer(column++);
  job.started_ms = row.integer(column++);
  job.finished_ms = row.integer(column++);
  job.result.seconds = row.real(column++);
  job.result.bytes_read = row.whole(column++);
  job.result.bytes_written = row.whole(column++);
  job.result.peak_rss_bytes = row.whole(column++);
  job.result.exit_code = static_cast<int>(row.integer(column++));
  job.result.reason = row.text(column++);
  job.result.log_tail = row.text(column++);
  job.forced = row.integer(column++) != 0;
  job.result.outputs = read_outputs(database, job.id);
  return job;
}

std::vector<Job> read_jobs(const Database& database, Statement rows) {
  std::vector<Job> jobs;
  while (rows.step()) jobs.push_back(read_job(database, rows));
  return jobs;
}

std::optional<Job> read_one(const Database& database, Statement rows) {
  if (!rows.step()) return std::nullopt;
  return read_job(database, rows);
}

/// "state = 'waiting'"; several: "state IN (...)".
std::string in_state(std::initializer_list<JobState> states) {
  std::string names;
  for (const JobState state : states) names += cat(names.empty() ? "'" : ", '", job_state_name(state), "'");
  return cat("state IN (", names, ")");
}

bool is_problem(JobState state) {
  return std::find(kProblemStates.begin(), kProblemStates.end(), state) != kProblemStates.end();
}

std::string sql_of(const JobOrder& order) {
  constexpr std::array kColumnsOfKeys{"changed_ms", "discovered_ms", "source", "state", "watch", "bytes", "seconds"};
  static_assert(kColumnsOfKeys.size() == kJobOrderKeys.size());
  const char* const way = order.descending ? " DESC" : "";
  return cat(kColumnsOfKeys[static_cast<std::size_t>(order.key)], way, ", id", way);
}

std::string where(const JobFilter& filter) {
  std::string condition = "WHERE 1";
  if (filter.state) condition += cat(" AND ", in_state({*filter.state}));
  if (!filter.watch.empty()) condition += " AND watch = ?";
  if (!filter.text.empty()) condition += " AND (instr(lower(source), lower(?)) OR instr(lower(reason), lower(?)))";
  if (!filter.problem.empty()) condition += " AND problem = ?";
  return condition;
}

void bind(Statement& statement, const JobFilter& filter) {
  if (!filter.watch.empty()) statement.bind(filter.watch);
  if (!filter.text.empty()) statement.bind(filter.text).bind(filter.text);
  if (!filter.problem.empty()) statement.bind(filter.problem);
}

// Times later than `now` become `now`.
void end_the_future(const Database& database, std::int64_t now) {
  for (const char* time : {"changed_ms", "discovered_ms", "queued_ms"}) {
    database.prepare(cat("UPDATE jobs SET ", time, " = ? WHERE ", time, " > ?")).bind(now).bind(now).step();
  }
}

std::string tail(const std::string& log) {
  return log.size() <= kLogTailBytes ? log : log.substr(log.size() - kLogTailBytes);
}

}  // namespace

std::int64_t backoff_ms(int attempts) {
  std::int64_t delay = kFirstDelay_ms;
  for (int i = 1; i < attempts && delay < kLongestDelay_ms; ++i) delay *= 2;
  return std::min(delay, kLongestDelay_ms);
}

std::int64_t JobStore::wall_clock_ms() {
  using std::chrono::milliseconds;
  return std::chrono::duration_cast<milliseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

JobStore::JobStore(const std::string& path, Clock clock)
    : clock_(std::move(clock)), database_(open_state_file(path, notice_)) {
  end_the_future(database_, now());
  Statement interrupted = database_.prepare(
      cat("UPDATE jobs SET state = 'waiting', changed_ms = ?, due_ms = 0 WHERE ", in_state({JobState::running})));
  interrupted.bind(latest_).step();
}

// Where the clock was set back, what is dated later than now would be the newest for as long as it was ahead.
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
  if (known && known->identity == identity && known->options == options) return {Change::none, known->state, *known};
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
  return {known ? Change::changed : Change::created, known ? std::optional(known->state) : std::nullopt,
          find(watch, source).value()};
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
      .prepare(cat("UPDATE jobs SET state = 'running', changed_ms = ?, started_ms = ? WHERE id = ? AND ",
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
          "forced = forced AND ?, ",
          kProblem, "WHERE id = ? AND ", in_state({JobState::running})));
  update.bind(job_state_name(to)).bind(now).bind(now).bind(attempts).bind(delay_ms == 0 ? 0 : now + delay_ms);
  update.bind(result.seconds).bind(result.bytes_read).bind(result.bytes_written).bind(result.peak_rss_bytes);
  update.bind(result.exit_code).bind(result.reason).bind(tail(result.log_tail)).bind(to != JobState::done);
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

bool JobStore::finish(std::int64_t id, const JobResult& result) {
  const std::optional<Job> known = job(id);
  return known && end_attempt(id, result, JobState::done, known->attempts, 0);
}

bool JobStore::fail(std::int64_t id, const JobResult& result) {
  const std::optional<Job> known = job(id);
  if (!known) return false;
  const int attempts = known->attempts + 1;
  const auto is = [&](ErrorKind kind) { return result.exit_code == static_cast<int>(kind); };
  if (is(ErrorKind::input)) return end_attempt(id, result, JobState::quarantined, attempts, 0);
  if (is(ErrorKind::usage) || is(ErrorKind::budget) || attempts >= kMaxAttempts) {
    return end_attempt(id, result, JobState::failed, attempts, 0);
  }
  return end_attempt(id, result, JobState::waiting, attempts, backoff_ms(attempts));
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
  if (!move(id, {JobState::running}, JobState::waiting, reason)) return false;
  if (delay_ms > 0) {
    database_.prepare("UPDATE jobs SET due_ms = ? WHERE id = ?").bind(now() + delay_ms).bind(id).step();
  }
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
  std::string kept = "0";
  for (std::size_t i = 0; i < watches.size(); ++i) kept += " OR (watch = ? AND substr(source, 1, length(?)) = ?)";
  Transaction transaction(database_);
  Statement forget = database_.prepare(
      cat("DELETE FROM jobs WHERE NOT (", kept, ") AND ",
          in_state({JobState::discovered, JobState::waiting, JobState::failed, JobState::quarantined})));
  for (const Watched& watch : watches) {
    const std::string below = watch.directory.ends_with('/') ? watch.directory : watch.directory + '/';
    forget.bind(watch.label).bind(below).bind(below);
  }
  forget.step();
  if (database_.changes() > 0) database_.prepare("DELETE FROM outputs WHERE job NOT IN (SELECT id FROM jobs)").step();
  transaction.commit();
}

std::optional<Job> JobStore::job(std::int64_t id) const {
  return read_one(database_, std::move(database_.prepare(cat(kColumns, "WHERE id = ?")).bind(id)));
}

std::optional<Job> JobStore::find(const std::string& watch, const std::string& source) const {
  Statement row = database_.prepare(cat(kColumns, "WHERE watch = ? AND source = ?"));
  row.bind(watch).bind(source);
  return read_one(database_, std::move(row));
}

std::vector<Job> JobStore::jobs(const JobFilter& filter, std::size_t offset, std::size_t limit,
                                const std::optional<JobOrder>& order) const {
  const std::string sorted = order                               ? sql_of(*order)
                             : filter.state == JobState::waiting ? "queued_ms, id"
                                                                 : "changed_ms DESC, id DESC";
  Statement rows = database_.prepare(cat(kColumns, where(filter), " ORDER BY ", sorted, " LIMIT ? OFFSET ?"));
  bind(rows, filter);
  rows.bind(std::uint64_t{limit}).bind(std::uint64_t{offset});
  return read_jobs(database_, std::move(rows));
}

std::vector<Job> JobStore::over_since(std::int64_t age_ms, std::int64_t after, std::size_t limit) const {
  Statement rows = database_.prepare(cat(kColumns, "WHERE id > ? AND changed_ms <= ? AND ",
                                         in_state({JobState::done, JobState::cancelled}), " ORDER BY id LIMIT ?"));
  rows.bind(after).bind(clock_() - age_ms).bind(std::uint64_t{limit});
  return read_jobs(database_, std::move(rows));
}

std::uint64_t JobStore::count(const JobFilter& filter) const {
  Statement row = database_.prepare(cat("SELECT count(*) FROM jobs ", where(filter)));
  bind(row, filter);
  row.step();
  return row.whole(0);
}

std::vector<JobStore::Problem> JobStore::with_problems(const std::string& problem) const {
  JobFilter filter;
  filter.problem = problem;
  Statement rows = database_.prepare(
      cat("SELECT id, watch, source FROM jobs ", where(filter), " AND ", in_state(kProblemStates), " ORDER BY id"));
  bind(rows, filter);
  std::vector<Problem> found;
  while (rows.step()) found.push_back({rows.integer(0), rows.text(1), rows.text(2)});
  return found;
}

std::vector<JobProblem> JobStore::problems(std::size_t limit) const {
  // Of a group, SQLite gives the columns of the row that has the largest changed_ms.
  Statement rows = database_.prepare(
      "SELECT problem, count(*), id, max(changed_ms) FROM jobs WHERE problem != '' GROUP BY problem "
      "ORDER BY 4 DESC, 3 DESC LIMIT ?");
  rows.bind(std::uint64_t{limit});
  std::vector<JobProblem> problems;
  while (rows.step()) problems.push_back({rows.text(0), rows.whole(1), job(rows.integer(2)).value()});
  return problems;
}

std::map<std::string, std::uint64_t> JobStore::waiting_bytes() const {
  Statement rows = database_.prepare(
      cat("SELECT watch, sum(bytes) FROM jobs WHERE ", in_state({JobState::waiting}), " GROUP BY watch"));
  std::map<std::string, std::uint64_t> bytes;
  while (rows.step()) bytes[rows.text(0)] = rows.whole(1);
  return bytes;
}

std::map<std::string, JobCounts> JobStore::counts() const {
  Statement rows = database_.prepare("SELECT watch, state, count(*) FROM jobs GROUP BY watch, state");
  std::map<std::string, JobCounts> counts;
  while (rows.step()) {
    const JobState state = parse_job_state(rows.text(1)).value();
    counts[rows.text(0)][static_cast<std::size_t>(state)] = rows.whole(2);
  }
  return counts;
}

std::vector<Job> JobStore::candidates(const std::string& watch, Priority priority, std::size_t limit) const {
  const std::int64_t now = clock_();
  const char* order = priority == Priority::newest ? "DESC" : "ASC";
  // A time further ahead than any delay was set before the clock went back.
  Statement rows = database_.prepare(cat(kColumns,
                                         "WHERE watch = ? AND state = 'waiting' AND (due_ms <= ? OR due_ms > ?) "
                                         "ORDER BY mtime_ns ",
                                         order, ", id ", order, " LIMIT ?"));
  rows.bind(watch).bind(now).bind(now + kLongestDelay_ms).bind(std::uint64_t{limit});
  return read_jobs(database_, std::move(rows));
}

std::optional<std::int64_t> JobStore::next_due_ms() const {
  const std::int64_t now = clock_();
  Statement row = database_.prepare(
      "SELECT min(due_ms) FROM jobs INDEXED BY jobs_due WHERE state = 'waiting' AND due_ms > ? AND due_ms <= ?");
  row.bind(now).bind(now + kLongestDelay_ms).step();
  if (row.is_null(0)) return std::nullopt;
  return row.integer(0) - now;
}

std::optional<std::int64_t> JobStore::queue_age_ms() const {
  Statement row = database_.prepare("SELECT min(queued_ms) FROM jobs INDEXED BY jobs_age WHERE state = 'waiting'");
  row.step();
  if (row.is_null(0)) return std::nullopt;
  return std::max<std::int64_t>(0, clock_() - row.integer(0));
}

}  // namespace weir
