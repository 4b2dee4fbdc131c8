#include "compressor/encode/encode_attempts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "compressor/encode/encode.h"
#include "compressor/encode/encoded_sums.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/digest.h"
#include "format/io/mapped_writes.h"
#include "format/process/process_memory.h"

namespace weir {
namespace {

// Returns a digest of everything that decides, for a given survey and options, where each leaf lies and what it holds.
Digest plan_digest(const FilePlan& file) {
  DigestStream digest;
  const auto regions = static_cast<std::int64_t>(file.tree->regions.size());
  for (std::int64_t region = 0; region < regions; ++region) {
    const LeafChoices choices = file.choices->read(region);
    digest.update(piece_digest(std::as_bytes(std::span(&choices, 1))));
  }
  const TreeLayout& layout = file.plan.layout;
  const std::array<std::uint64_t, 6> places{layout.leaves,
                                            layout.counts.leaves,
                                            layout.packed_data,
                                            layout.file_bytes,
                                            std::bit_cast<std::uint32_t>(file.fill.background),
                                            static_cast<std::uint64_t>(file.encoding)};
  digest.update(piece_digest(std::as_bytes(std::span(places))));
  return digest.digest();
}

// Keeps what an earlier process encoded if it had this very plan. If not, discards it and saves the journal before the
// first of its bytes is overwritten.
void adopt_plan(Journal& journal, const Digest& plan) {
  Checkpoint& state = journal.state;
  if (state.plan == plan) return;
  state.plan = plan;
  if (state.encoded.done.empty()) return;
  state.encoded = {};
  journal.save_now();
}

// Opens the files for the leaves and their records. Clears them unless they hold encoded leaves of this plan.
std::shared_ptr<File> open_targets(const EncodeJob& job, const FilePlan& file) {
  if (job.journal == nullptr) {
    job.rows.team().publish(job.output.volume());  // waits until no bytes of an earlier attempt can arrive any more
    job.output.clear_for(file.size.bytes);
    return job.work.spill_records();
  }
  adopt_plan(*job.journal, plan_digest(file));
  job.output.write_to(job.journal->open("volume"));
  std::shared_ptr<File> records = job.journal->open("records");
  if (job.journal->state.encoded.done.empty()) {
    job.output.volume().clear();
    records->clear();
  }
  return records;
}

// Keeps what an earlier process encoded if its files are still as it wrote them. Otherwise clears the files.
void check_written(const EncodeJob& job, const EncodeTarget& target, File& records) {
  Checkpoint& state = job.journal->state;
  if (state.encoded.done.empty()) return;
  const EncodedSums written = sums_of_written(target, state.encoded.done);
  const bool volume = written.volume == state.encoded.sums.volume && has_empty_padding(target);
  if (volume && written.records == state.encoded.sums.records) return;
  const char* const damaged = volume ? "records" : "volume";
  if (job.notice) {
    job.notice(cat(job.journal->output(), ": what was encoded of it is encoded again: ", job.journal->path_of(damaged),
                   " is damaged"));
  }
  state.encoded = {};
  job.journal->save_now();
  job.output.volume().clear();
  records.clear();
}

FilePlan select_file(const EncodeJob& job, FileRequest& request) {
  for (;;) {
    FilePlan file = [&] {
      const TraceSpan span(job.stream.trace, "select");
      return plan_file(request, job.rows, job.work);
    }();
    if (!request.packed.window || !file.cut || request.packed.window->holds(*file.cut)) return file;
    job.move_window(request, *file.cut);
  }
}

// Returns whether each region's part of the tree is written as soon as the region is encoded, so that no records are
// kept. The macrocells of all regions then stay in memory. They fit if the records would fit.
bool finishes_regions(const EncodeJob& job, const FilePlan& file) {
  return job.work.holds_records() &&
         encodes_by_regions(job.source, file.packed.has_value(), job.rows.team(), job.journal != nullptr);
}

// Maps the output file if the volume lies on a device and the file lies on a memory file system with its space
// reserved. Returns null otherwise, and if the rest of the memory would not hold the file and the records.
std::unique_ptr<MappedWrites> mapped_writes(const EncodeJob& job, const FilePlan& file) {
  if (job.source.resident() == nullptr || !job.rows.team().alone()) return nullptr;
  constexpr std::uint64_t kBeside = std::uint64_t{256} << 20U;
  const std::uint64_t records = finishes_regions(job, file) ? 0 : file.plan.kept * sizeof(LeafRecord);
  const std::uint64_t needed = file.size.bytes + records + kBeside;
  if (resident_bytes() + needed > job.memory || !job.output.in_memory()) return nullptr;
  return MappedWrites::of(job.output.volume(), file.size.bytes);
}

EncodedFile encode_once(const EncodeJob& job, FileRequest& request) {
  EncodedFile encoded;
  encoded.file = select_file(job, request);
  const FilePlan& file = encoded.file;
  const bool by_regions = finishes_regions(job, file);
  const std::shared_ptr<File> records = open_targets(job, file);
  if (!by_regions) encoded.records = std::make_unique<RecordStore>(records, file.plan.kept);
  if (file.packed) {
    const bool bounded = request.budget.kind == Budget::Kind::max_error;
    encoded.packed = std::make_unique<PackedTarget>(
        PackedTarget{*file.streams, *file.packed, request.packed.constants, request.packed.lattice,
                     bounded ? std::optional(request.budget.target) : std::nullopt, job.coder});
  }
  const auto reserve = [&] {
    if (job.planned) job.planned(file.size.bytes);
    const bool reserved = job.output.reserve(file.size.bytes);
    if (!reserved && job.notice) {
      job.notice(
          cat(job.output.directory(), ": this file system cannot reserve space; a full disk will show while writing"));
    }
    return reserved;
  };
  if (job.journal == nullptr && reserve()) encoded.mapped = mapped_writes(job, file);
  File& out = encoded.mapped ? *encoded.mapped : job.output.volume();
  const ChoiceStore* const seen_by = request.rule.visibility == nullptr ? nullptr : file.choices.get();
  if (by_regions) encoded.regions = std::make_unique<FinishedRegions>(tree_parts(encoded, job.rows), out, seen_by);
  const Fit fit = request.budget.kind == Budget::Kind::max_error ? Fit::largest : Fit::squares;
  const EncodeTarget target{*file.tree,
                            *file.choices,
                            file.plan.layout,
                            file.fill,
                            grid_type_of(file.encoding),
                            fit,
                            out,
                            encoded.records.get(),
                            job.rows,
                            job.stream.trace,
                            encoded.packed.get(),
                            job.journal != nullptr,
                            encoded.regions.get()};
  if (job.journal != nullptr) {
    check_written(job, target, *records);
    reserve();
  }
  job.pass_started();
  const TraceSpan span(job.stream.trace, "encode pass");
  Pauses pauses;
  if (job.journal != nullptr) pauses = {[&] { return job.journal->due(); }, [&] { job.journal->save(); }};
  Team& team = job.rows.team();
  team.run([&] {
    encode_leaves(job.source, job.plan, target, job.stream, job.reading,
                  job.journal == nullptr ? nullptr : &job.journal->state.encoded, pauses);
  });
  if (by_regions) {
    encoded.errors = encoded.regions->errors();
    encoded.seen_errors = encoded.regions->seen_errors();
    return encoded;
  }
  encoded.records->publish(team);
  encoded.errors = sum_leaf_errors(*file.tree, *encoded.records, nullptr, team);
  encoded.seen_errors =
      seen_by == nullptr ? encoded.errors : sum_leaf_errors(*file.tree, *encoded.records, seen_by, team);
  return encoded;
}

// Returns the squared error of the decoded file over the finite voxels that can be seen.
double seen_error(const EncodedFile& encoded) {
  return encoded.file.plan.seen_tiles.squared + encoded.seen_errors.squared;
}

// Returns whether the file keeps the promise that the budget makes about its values.
bool keeps_promise(const EncodedFile& encoded, const FileRequest& request) {
  const DecodedErrors& tiles = encoded.file.plan.seen_tiles;
  const DecodedErrors& leaves = encoded.seen_errors;
  switch (request.budget.kind) {
    case Budget::Kind::psnr:
      return seen_error(encoded) <= request.squared_error;
    case Budget::Kind::max_error:
      return std::max(tiles.max_abs, leaves.max_abs) <= request.budget.target;
    case Budget::Kind::lossless:
      return std::min(tiles.kept, leaves.kept) == Kept::all;
    case Budget::Kind::automatic:
      return request.budget.target == 0 || seen_error(encoded) <= request.squared_error;
    case Budget::Kind::size:
    case Budget::Kind::rate:
      break;
  }
  return true;
}

// The attempts at one file. The result of each attempt decides the request of the next one.
struct Attempts {
  static constexpr int kMostEstimated = 6;  // attempts by estimate; the next one is sure to keep the promise

  const FileRequest asked;
  const RowStore& rows;
  WorkDirectory& work;
  FileRequest request = asked;
  int number = 0;
  std::optional<double> met = {};  // the planned error of an earlier file that met the target

  // Returns whether another attempt must follow `encoded`, and sets up its request. Expectations come from the survey's
  // estimates, but decoded values decide. Throws Error(budget) if the requested encoding cannot do better.
  bool adjust(const EncodedFile& encoded) {
    const bool kept = keeps_promise(encoded, request);
    if (!kept && request.budget.kind == Budget::Kind::automatic) {
      raise_quality();
      return true;
    }
    if (encoded.file.encoding == Encoding::float32) {
      if (kept) return false;
      throw Error(ErrorKind::internal, cat(request.path, ": float leaves miss what was asked; report this"));
    }
    if (request.budget.kind != Budget::Kind::psnr) {
      if (kept && !loses_more_than_float(encoded)) return false;
      take_float(encoded);
      return true;
    }
    // A file within 3 % (0.13 dB) of the requested error is small enough.
    const double error = seen_error(encoded);
    const bool may_lose_more = number + 1 < kMostEstimated && expects_loss_of_nothing(encoded);
    if (kept && !may_lose_more && (number >= 2 || error >= 0.97 * request.squared_error || !(error > 0))) return false;
    const bool exhausted = !kept && keeps_everything(encoded);
    if (kept) met = request.planned_error;
    request.adjusted = true;
    if (may_lose_more) {
      request.planned_error *= 8;
    } else if (number + 1 < kMostEstimated && !exhausted) {
      // A volume of few leaves has few errors to choose from. If the last step led to the same choice, takes a longer
      // one.
      request.planned_error *= request.squared_error / error * (kept ? 0.995 : 1 - std::ldexp(0.002, 2 * number));
    } else if (met) {
      request.planned_error = *met;
      met.reset();
    } else if (request.encoding != Encoding::automatic && !exhausted) {
      request.planned_error = 0;
    } else {
      take_float(encoded);
    }
    return true;
  }

  // Returns whether raise_quality() has made the request ask for more than the default, which the user did not ask for.
  bool raised() const {
    return asked.budget.kind == Budget::Kind::automatic && request.budget.kind != asked.budget.kind;
  }

  // Begins again with the first attempt, for the file of the default rate, whatever it keeps.
  void keep_default() {
    begin_again();
    request.budget.target = 0;
  }

 private:
  // Returns whether the file loses more than a float file would. If only a bound of the float file's error is known,
  // and the bound does not decide, plans the float file.
  bool loses_more_than_float(const EncodedFile& encoded) const {
    const double error = seen_error(encoded);
    if (error <= encoded.file.float_error) return false;
    if (!encoded.file.float_error_is_bound) return true;
    FileRequest whole = request;
    whole.plans_float = true;
    const FilePlan file = plan_file(whole, rows, work);
    return file.encoding == Encoding::float32 || error > file.float_error;
  }

  void begin_again() {
    const auto window = request.packed.window;  // the window of the existing ladders
    request = asked;
    request.packed.window = window;
    number = -1;
    met.reset();
  }

  // Begins again with the first attempt and a higher quality, because the default rate would destroy the volume.
  void raise_quality() {
    begin_again();
    const std::uint64_t dense = float32_bytes(request.domain);
    if (request.encoding == Encoding::automatic || request.encoding == Encoding::float32) {
      request.budget.kind = Budget::Kind::lossless;
      if (plan_file(request, rows, work).size.bytes < dense) return;
    }
    request.budget.kind = Budget::Kind::psnr;
  }

  // Returns whether the file loses nothing although a loss was expected. This happens with voxels without a value,
  // which an estimate knows too little about. A smaller file may then do as well.
  bool expects_loss_of_nothing(const EncodedFile& encoded) const {
    return !(seen_error(encoded) > 0) && encoded.file.plan.expected_error > 0 && request.planned_error > 0;
  }

  // Returns whether every leaf is already kept as well as this encoding can.
  bool keeps_everything(const EncodedFile& encoded) const {
    return encoded.file.plan.expected_error > request.planned_error || request.planned_error == 0;
  }

  void take_float(const EncodedFile& encoded) {
    if (request.encoding != Encoding::automatic) {
      throw unmet_target(request, encoded.file.encoding, seen_error(encoded));
    }
    request.encoding = Encoding::float32;
  }
};

// Returns the share of the requested error that the first file is planned for. It is below 1 by as much as estimates
// are off. Otherwise every second file would miss the target by that much and be made again.
double planned_share(Encoding encoding) {
  if (encoding == Encoding::float32) return 1;
  // The errors of coefficients match those of values to parts of 10,000.
  return encoding == Encoding::packed ? 0.999 : 0.985;
}

}  // namespace

TreeParts tree_parts(const EncodedFile& encoded, const RowStore& rows) {
  const FilePlan& file = encoded.file;
  return {*file.tree, rows, *file.choices, encoded.records.get(), file.fill, file.plan.layout, encoded.packed.get()};
}

EncodedFile encode_file(const EncodeJob& job, FileRequest request) {
  request.planned_error = planned_share(request.encoding) * request.squared_error;
  Attempts attempts{std::move(request), job.rows, job.work};
  // A volume that the default may be raised for is small. Its attempts begin anew, so that they end with the same file.
  const bool may_raise = attempts.asked.budget.kind == Budget::Kind::automatic && attempts.asked.budget.target > 0;
  if (!may_raise && job.journal != nullptr && job.journal->state.attempt &&
      job.journal->state.attempt->seen == job.seen) {
    const Checkpoint::Attempt& interrupted = *job.journal->state.attempt;
    attempts.number = interrupted.number;
    attempts.request.planned_error = interrupted.planned_error;
    attempts.request.adjusted = interrupted.number > 0;
    attempts.request.encoding = interrupted.encoding;
    attempts.met = interrupted.met;
  }
  for (;; ++attempts.number) {
    if (job.journal != nullptr) {
      job.journal->state.attempt = {attempts.number, attempts.request.planned_error, attempts.request.encoding,
                                    job.seen, attempts.met};
    }
    try {
      EncodedFile encoded = encode_once(job, attempts.request);
      if (!attempts.adjust(encoded)) return encoded;
    } catch (const Error& error) {  // on all ranks
      if (error.kind() != ErrorKind::budget || !attempts.raised()) throw;
      attempts.keep_default();
    }
  }
}

}  // namespace weir
