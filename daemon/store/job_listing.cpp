#include "daemon/store/job_listing.h"

#include <algorithm>

#include "format/base/text.h"

namespace weir {
namespace {

constexpr const char* kColumns =
    "SELECT id, watch, source, options, bytes, mtime_ns, inode, state, attempts, discovered_ms, changed_ms, queued_ms, "
    "due_ms, started_ms, finished_ms, seconds, bytes_read, bytes_written, peak_rss_bytes, exit_code, reason, log_tail, "
    "forced, source_bytes "
    "FROM jobs ";

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
  job.state = parse_job_state(row.text(column++)).value();  // the table allows no other value
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
  job.result.source_bytes = row.whole(column++);
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

std::string sql_of(const JobOrder& order) {
  constexpr std::array kColumnsOfKeys{
      "changed_ms", "discovered_ms", "source", "state", "watch", "max(bytes, source_bytes)", "seconds"};
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

}  // namespace

std::string in_state(std::initializer_list<JobState> states) {
  std::string names;
  for (const JobState state : states) names += cat(names.empty() ? "'" : ", '", job_state_name(state), "'");
  return cat("state IN (", names, ")");
}

std::optional<Job> JobListing::job(std::int64_t id) const {
  return read_one(database_, std::move(database_.prepare(cat(kColumns, "WHERE id = ?")).bind(id)));
}

std::optional<Job> JobListing::find(const std::string& watch, const std::string& source) const {
  Statement row = database_.prepare(cat(kColumns, "WHERE watch = ? AND source = ?"));
  row.bind(watch).bind(source);
  return read_one(database_, std::move(row));
}

std::vector<Job> JobListing::jobs(const JobFilter& filter, std::size_t offset, std::size_t limit,
                                  const std::optional<JobOrder>& order) const {
  const std::string sorted = order                               ? sql_of(*order)
                             : filter.state == JobState::waiting ? "queued_ms, id"
                                                                 : "changed_ms DESC, id DESC";
  Statement rows = database_.prepare(cat(kColumns, where(filter), " ORDER BY ", sorted, " LIMIT ? OFFSET ?"));
  bind(rows, filter);
  rows.bind(std::uint64_t{limit}).bind(std::uint64_t{offset});
  return read_jobs(database_, std::move(rows));
}

std::vector<Job> JobListing::over_since(std::int64_t age_ms, std::int64_t after, std::size_t limit) const {
  Statement rows = database_.prepare(cat(kColumns, "WHERE id > ? AND changed_ms <= ? AND ",
                                         in_state({JobState::done, JobState::cancelled}), " ORDER BY id LIMIT ?"));
  rows.bind(after).bind(clock_() - age_ms).bind(std::uint64_t{limit});
  return read_jobs(database_, std::move(rows));
}

std::vector<std::int64_t> JobListing::unrendered() const {
  Statement rows = database_.prepare(
      cat("SELECT id FROM jobs WHERE rendering = 1 AND ", in_state({JobState::done}), " ORDER BY id"));
  std::vector<std::int64_t> ids;
  while (rows.step()) ids.push_back(rows.integer(0));
  return ids;
}

std::vector<JobListing::Source> JobListing::sources(const std::string& watch, JobState state, const SourcePlace& place,
                                                    std::size_t limit) const {
  Statement rows =
      database_.prepare(cat("SELECT id, source, mtime_ns FROM jobs INDEXED BY jobs_queue WHERE watch = ? AND state = '",
                            job_state_name(state), "' AND (mtime_ns, id) > (?, ?) ORDER BY mtime_ns, id LIMIT ?"));
  rows.bind(watch).bind(place.mtime_ns).bind(place.id).bind(std::uint64_t{limit});
  std::vector<Source> sources;
  while (rows.step()) sources.push_back({rows.integer(0), rows.text(1), rows.integer(2)});
  return sources;
}

std::uint64_t JobListing::count(const JobFilter& filter) const {
  Statement row = database_.prepare(cat("SELECT count(*) FROM jobs ", where(filter)));
  bind(row, filter);
  row.step();
  return row.whole(0);
}

std::vector<JobListing::Problem> JobListing::with_problems(const std::string& problem) const {
  JobFilter filter;
  filter.problem = problem;
  Statement rows = database_.prepare(
      cat("SELECT id, watch, source FROM jobs ", where(filter), " AND ", in_state(kProblemStates), " ORDER BY id"));
  bind(rows, filter);
  std::vector<Problem> found;
  while (rows.step()) found.push_back({rows.integer(0), rows.text(1), rows.text(2)});
  return found;
}

std::vector<JobProblem> JobListing::problems(std::size_t limit) const {
  // In a group, SQLite returns the columns of the row with the largest changed_ms.
  Statement rows = database_.prepare(
      "SELECT problem, count(*), id, max(changed_ms) FROM jobs WHERE problem != '' GROUP BY problem "
      "ORDER BY 4 DESC, 3 DESC LIMIT ?");
  rows.bind(std::uint64_t{limit});
  std::vector<JobProblem> problems;
  while (rows.step()) problems.push_back({rows.text(0), rows.whole(1), job(rows.integer(2)).value()});
  return problems;
}

std::map<std::string, std::uint64_t> JobListing::waiting_bytes() const {
  Statement rows = database_.prepare(
      cat("SELECT watch, sum(bytes) FROM jobs WHERE ", in_state({JobState::waiting}), " GROUP BY watch"));
  std::map<std::string, std::uint64_t> bytes;
  while (rows.step()) bytes[rows.text(0)] = rows.whole(1);
  return bytes;
}

std::map<std::string, JobCounts> JobListing::counts() const {
  Statement rows = database_.prepare("SELECT watch, state, count(*) FROM jobs GROUP BY watch, state");
  std::map<std::string, JobCounts> counts;
  while (rows.step()) {
    const JobState state = parse_job_state(rows.text(1)).value();
    counts[rows.text(0)][static_cast<std::size_t>(state)] = rows.whole(2);
  }
  return counts;
}

std::vector<Job> JobListing::candidates(const std::string& watch, Priority priority, std::size_t limit) const {
  const std::int64_t now = clock_();
  const char* order = priority == Priority::newest ? "DESC" : "ASC";
  // A job with a change after `now` was changed before the clock was set back.
  Statement rows = database_.prepare(cat(kColumns,
                                         "WHERE watch = ? AND state = 'waiting' AND (due_ms <= ? OR changed_ms > ?) "
                                         "ORDER BY mtime_ns ",
                                         order, ", id ", order, " LIMIT ?"));
  rows.bind(watch).bind(now).bind(now).bind(std::uint64_t{limit});
  return read_jobs(database_, std::move(rows));
}

std::optional<std::int64_t> JobListing::next_due_ms() const {
  const std::int64_t now = clock_();
  Statement row = database_.prepare(
      "SELECT min(due_ms) FROM jobs INDEXED BY jobs_due WHERE state = 'waiting' AND due_ms > ? AND changed_ms <= ?");
  row.bind(now).bind(now).step();
  if (row.is_null(0)) return std::nullopt;
  return row.integer(0) - now;
}

std::optional<std::int64_t> JobListing::queue_age_ms() const {
  Statement row = database_.prepare("SELECT min(queued_ms) FROM jobs INDEXED BY jobs_age WHERE state = 'waiting'");
  row.step();
  if (row.is_null(0)) return std::nullopt;
  return std::max<std::int64_t>(0, clock_() - row.integer(0));
}

}  // namespace weir
