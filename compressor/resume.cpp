#include "compressor/resume.h"

#include "compressor/conversion_identity.h"
#include "compressor/resume/work_directory.h"
#include "format/base/text.h"
#include "format/io/output_names.h"
#include "format/output/commit_leftovers.h"
#include "format/output/output_place.h"
#include "format/sidecar/sidecar.h"

namespace weir {
namespace {

// A smaller volume is converted in two seconds from memory. If a disk makes it slower, a continued conversion would
// wait for the disk again.
constexpr std::uint64_t kResumableBytes = std::uint64_t{1} << 30U;

bool is_final(const Error& error) {
  return error.kind() == ErrorKind::input || error.kind() == ErrorKind::budget || error.kind() == ErrorKind::internal;
}

}  // namespace

bool is_resumable(const SourceInfo& info, const ConversionOptions& options, bool in_memory) {
  const bool large = float32_bytes(info.domain()) >= kResumableBytes;
  return !in_memory && (options.resume == Resume::on || (options.resume == Resume::automatic && large));
}

void require_lasting_output(const ConversionOptions& options, bool in_memory) {
  if (options.resume != Resume::on || !in_memory) return;
  throw Error(ErrorKind::usage,
              compose(option("resume", "on"), ": ", options.output,
                      " lies on a memory file system; choose an output on a disk or ", option("resume", "off")));
}

std::unique_ptr<Journal> open_journal(const SourceInfo& info, const ConversionOptions& options,
                                      const ConversionControl& control, const OutputFiles& output, FileSystem& files) {
  const bool in_memory = files.is_memory(output.directory());
  require_lasting_output(options, in_memory);
  if (!is_resumable(info, options, in_memory)) {
    if (remove_leftovers(files, options.output) && control.notice) control.notice(leftovers_notice(options.output));
    // The hidden directory stays if it is this conversion's WorkDirectory.
    if (!options.work_dir.empty() || in_memory) remove_if_empty(files, hidden_directory_of(options.output));
    return nullptr;
  }
  return std::make_unique<Journal>(
      files, options.output, identify_conversion(info, options),
      JournalOptions{options.work_dir, options.save_interval_s, control.cancel, control.trace, control.notice});
}

namespace {

// Removes everything except the lock, OUT.nvdb.partial, which the caller holds.
void discard_all_but_lock(FileSystem& files, const std::string& output) {
  const std::string sidecar = sidecar_path(output);
  const std::string previous = previous_path(sidecar);
  if (const std::string unfinished = partial_path(sidecar); files.exists(unfinished)) {
    files.create(unfinished);  // throws if the file belongs to somebody else
    files.remove(unfinished);
  }
  if (files.exists(previous) && belongs_back(files, previous, sidecar, output)) files.rename(previous, sidecar);
  remove_leftovers(files, output);
  remove_if_empty(files, hidden_directory_of(output));
  files.remove(previous);
}

}  // namespace

bool discard_all_beside(FileSystem& files, const std::string& output) {
  const std::string hidden = hidden_directory_of(output);
  const std::string partial = partial_path(output);
  const bool locked = files.exists(partial);
  const bool other = locked || files.exists(previous_path(sidecar_path(output)));
  if (!other && !files.exists(hidden)) return false;
  // The lock file is neither emptied nor removed before everything else is removed. Its content says that the output
  // is done (is_committed), and must still say so if this process is killed.
  const std::unique_ptr<File> lock = files.open(partial);
  require_alone(*lock);
  try {
    discard_all_but_lock(files, output);
  } catch (const Error&) {
    if (!locked) files.remove(partial);
    throw;
  }
  files.remove(partial);
  return other || !files.exists(hidden);  // it stays if other files are in it
}

void clear_after_commit(FileSystem& files, const std::string& output) {
  if (is_committed(files, output)) {
    discard_all_beside(files, output);
  } else if (files.exists(output) && !files.exists(partial_path(output))) {
    // A conversion without a journal keeps no named files in the hidden directory.
    remove_if_empty(files, hidden_directory_of(output));
  }
}

std::string continued_notice(const std::string& output, const Checkpoint& state, std::int64_t leaves) {
  return cat(output, ": continues a conversion that was interrupted, survey ", 100 * state.survey.done.size() / leaves,
             " %, encode ", 100 * state.encoded.done.size() / leaves, " % done");
}

Error ended_with(const Error& error, Journal& journal) {
  if (is_final(error)) {
    journal.discard();
    return error;
  }
  const bool interrupted = error.kind() == ErrorKind::interrupted;
  try {
    const bool begun = !journal.state.survey.done.empty() || !journal.state.encoded.done.empty();
    if (interrupted && begun) journal.save_now();
  } catch (const Error&) {
    // The state that was saved earlier counts.
  }
  if (!journal.resumable()) return error;
  return {error.kind(),
          compose(interrupted ? Message("interrupted") : error.message(), "; what is done is kept in ",
                  journal.directory(), ", the same command continues it"),
          error.system_failure()};
}

}  // namespace weir
