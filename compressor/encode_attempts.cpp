#include "compressor/encode_attempts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "compressor/encode.h"
#include "format/digest.h"
#include "format/text.h"

namespace weir {
namespace {

// Of all that decides where which leaf lies and what it holds, once the survey and the options are given.
Digest plan_digest(const FilePlan& file) {
  DigestStream digest;
  const auto regions = static_cast<std::int64_t>(file.tree->regions.size());
  for (std::int64_t region = 0; region < regions; ++region) {
    const LeafChoices choices = file.choices->read(region);
    digest.update(piece_digest(std::as_bytes(std::span(&choices, 1))));
  }
  const TreeLayout& layout = file.plan.layout;
  const std::array<std::uint64_t, 5> places{layout.leaves, layout.counts.leaves, layout.file_bytes,
                                            std::bit_cast<std::uint32_t>(file.fill.background),
                                            static_cast<std::uint64_t>(file.encoding)};
  digest.update(piece_digest(std::as_bytes(std::span(places))));
  return digest.digest();
}

// What an earlier process wrote counts if it was of this very plan. If not, that is saved before the first of its bytes
// is overwritten.
void adopt_plan(Journal& journal, const Digest& plan) {
  Checkpoint& state = journal.state;
  if (state.plan == plan) return;
  state.plan = plan;
  if (state.encoded.empty()) return;
  state.encoded = {};
  journal.save_now();
}

// The files that the leaves and their records go to, empty but for what counts.
std::shared_ptr<File> open_targets(const EncodeJob& job, const FilePlan& file) {
  if (job.journal == nullptr) {
    job.rows.team().publish(job.output.volume());  // nothing of an earlier attempt comes after this one's
    job.output.volume().clear();
    return job.work.spill();
  }
  adopt_plan(*job.journal, plan_digest(file));
  job.output.write_to(job.journal->open("volume"));
  std::shared_ptr<File> records = job.journal->open("records");
  if (job.journal->state.encoded.empty()) {
    job.output.volume().clear();
    records->clear();
  }
  return records;
}

EncodedFile encode_once(const EncodeJob& job, const FileRequest& request) {
  EncodedFile encoded;
  {
    const TraceSpan span(job.stream.trace, "select");
    encoded.file = plan_file(request, job.rows, job.work);
  }
  const FilePlan& file = encoded.file;
  std::shared_ptr<File> records = open_targets(job, file);
  if (!job.output.reserve(file.size.bytes) && job.notice) {
    job.notice(
        cat(job.output.directory(), ": this file system cannot reserve space; a full disk will show while writing"));
  }
  encoded.records = std::make_unique<RecordStore>(std::move(records), file.plan.layout.counts.leaves);
  job.pass_started();
  const TraceSpan span(job.stream.trace, "encode pass");
  const Fit fit = request.budget.kind == Budget::Kind::max_error ? Fit::largest : Fit::squares;
  Pauses pauses;
  if (job.journal != nullptr) pauses = {[&] { return job.journal->due(); }, [&] { job.journal->save(); }};
  Team& team = job.rows.team();
  team.run([&] {
    encode_leaves(job.source, job.plan,
                  {*file.tree, *file.choices, file.plan.layout, file.fill, grid_type_of(file.encoding), fit,
                   job.output.volume(), *encoded.records, job.stream.trace, team},
                  job.stream, job.reading, job.journal == nullptr ? nullptr : &job.journal->state.encoded, pauses);
  });
  encoded.records->publish(team);
  encoded.errors = sum_leaf_errors(*file.tree, *encoded.records, nullptr, team);
  encoded.seen_errors = request.rule.visibility == nullptr
                            ? encoded.errors
                            : sum_leaf_errors(*file.tree, *encoded.records, file.choices.get(), team);
  return encoded;
}

// Whether another attempt should be made at an error target, and with which expected error. Expectations come from
// the survey's estimates; decoded values decide. A file within 2 % of the error asked is small enough.
bool adjust_target(const EncodedFile& encoded, double target, int attempt, FileRequest& request) {
  if (encoded.file.encoding == Encoding::float32) return false;  // exact
  constexpr int kMostAttempts = 6;
  if (request.budget.kind == Budget::Kind::max_error) {
    if (encoded.seen_errors.max_abs <= request.budget.target) return false;
    request.encoding = Encoding::float32;
    return true;
  }
  const double error = encoded.file.plan.seen_tiles.squared + encoded.seen_errors.squared;
  const bool met = error <= target;
  if (met && (attempt >= 2 || error >= 0.98 * target || !(error > 0))) return false;
  if (attempt + 1 >= kMostAttempts) {
    request.encoding = Encoding::float32;
    return !met;
  }
  // A volume of few leaves has few errors to choose from: the same choice again calls for a longer step.
  request.squared_error *= target / error * (met ? 0.995 : 1 - std::ldexp(0.002, 2 * attempt));
  return true;
}

}  // namespace

EncodedFile encode_file(const EncodeJob& job, FileRequest request) {
  const double target = request.squared_error;
  int attempt = 0;
  const bool continues =
      job.journal != nullptr && job.journal->state.attempt && job.journal->state.attempt->seen == job.seen;
  if (continues) {
    const Checkpoint::Attempt& interrupted = *job.journal->state.attempt;
    attempt = interrupted.number;
    request.squared_error = interrupted.squared_error;
    request.encoding = interrupted.encoding;
  }
  for (;; ++attempt) {
    if (job.journal != nullptr) {
      job.journal->state.attempt = {attempt, request.squared_error, request.encoding, job.seen};
    }
    EncodedFile encoded = encode_once(job, request);
    if (!request.budget.by_error() || !adjust_target(encoded, target, attempt, request)) return encoded;
  }
}

}  // namespace weir
