#include "compressor/conversion.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "compressor/conversion_control.h"
#include "compressor/conversion_memory.h"
#include "compressor/damaged_input.h"
#include "compressor/look_ahead.h"
#include "compressor/plan/memory_plan.h"
#include "compressor/plan/own_threads.h"
#include "compressor/plan/startable_threads.h"
#include "compressor/resume.h"
#include "compressor/select/file_size.h"
#include "compressor/survey/spill_sums.h"
#include "compressor/surveyed_conversion.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_id.h"
#include "format/io/memory_file_system.h"
#include "format/io/output_names.h"
#include "format/io/reused_pages.h"
#include "format/process/fork_guard.h"
#include "format/process/process_memory.h"
#include "ingest/drivers/hdf5_crash.h"
#include "ingest/source/cell_places.h"
#include "ingest/source/source_files.h"

namespace weir {

namespace {

std::uint64_t voxels_of(const BoxSet& leaves, const BlockPlan& plan) {
  std::int64_t voxels = 0;
  for (const Box& box : leaves.boxes()) voxels += plan.voxel_box(box).voxels();
  return static_cast<std::uint64_t>(voxels);
}

// Returns the cause of `error`. A source file that changes during the conversion first causes some format error, and a
// user would then look for damage in a file that is whole. So an input error is replaced if a source file changed.
Error with_its_cause(const Error& error, const SourceInfo& info) {
  if (error.kind() == ErrorKind::interrupted) return interrupted_error();
  if (error.kind() != ErrorKind::input) return error;
  try {
    check_unchanged(info.files);
  } catch (const Error& changed) {
    return changed;
  }
  return error;
}

// Tells `notice` what the file says about axes and values if the volume is not what it looks like.
void say_axes(const SourceInfo& info, const Notice& notice) {
  const std::string volume = cat(info.path, ": ", info.dataset, info.dataset.empty() ? "" : ": ");
  for (std::size_t i = 0; notice && i < info.details.axes.size(); ++i) {
    const std::string& note = info.details.axes.at(i).note;
    const std::string& label = info.axis_labels.at(i);
    if (note.empty()) continue;
    const Message line = cat(volume, "axis ", "xyz"[i], label.empty() ? "" : " (", label, label.empty() ? "" : ")",
                             info.details.axes.at(i).reversed ? " " : ": ", note);
    const bool irregular = !info.details.axes.at(i).coordinates.empty();
    notice(irregular ? compose(line, ", ", info.spacing.at(i), " apart; ", option("spacing"), " sets another distance")
                     : line);
  }
  for (const std::string& note : {info.details.order_note, info.details.orientation, info.details.values_note,
                                  info.details.data_note, info.details.chunks_note}) {
    if (notice && !note.empty()) notice(cat(volume, note));
  }
  if (!notice || info.details.units_note.empty()) return;
  notice(compose(volume, info.details.units_note, ": positions are in different units; ", option("spacing"), " and ",
                 option("origin"), " set them in one"));
}

// Reserves the disk space of an output of known size while its volume is surveyed. Not if `control.planned` must be
// asked for the space first, and not for an output so small that reserving it is quick.
void reserve_ahead(OutputFiles& output, const ConversionOptions& options, const ConversionControl& control,
                   VolumeSource& source) {
  constexpr std::uint64_t kLeastBytes = std::uint64_t{16} << 20U;
  const Budget::Kind kind = options.budget.kind;
  if (control.planned || !control.pads_file || (kind != Budget::Kind::size && kind != Budget::Kind::rate)) return;
  const std::uint64_t dense = float32_bytes(source.info().domain());
  const std::uint64_t bytes = asked_bytes(options.budget, dense);
  if (bytes < kLeastBytes || bytes >= dense) return;
  using Pages = OutputFiles::Pages;  // files of volumes on a device are mapped
  output.reserve_ahead(bytes, source.resident() != nullptr ? Pages::cleared : Pages::as_they_are);
}

// Forgets the survey of an earlier process if its files are not as that process wrote them.
void forget_damaged(Journal& journal, const SurveyStores& stores, const std::optional<LadderAim>& aim) {
  const SurveyState& survey = journal.state.survey;
  if (survey.done.empty()) return;
  const bool all = journal.state.ladders.rebuilt;
  const RebuiltLadders rebuilt{all || (aim && !aim->background && !aim->keeps_non_finite), all};
  const auto damaged =
      damaged_spill(stores.rows, stores.faces ? &*stores.faces : nullptr, survey.done, survey.tally.sums, rebuilt);
  if (damaged) journal.forget(cat(journal.path_of(std::string(*damaged)), " is damaged"));
}

// Returns whether the conversion's files may reuse pages of earlier files: if the volume is packed on a device.
bool reuses_pages(VolumeSource& source, const ConversionOptions& options) {
  return source.resident() != nullptr && options.encoding == Encoding::packed;
}

// Unmaps the pages of earlier files if this conversion does not reuse them, or if options.memory is too small beside
// them. The pages count as the process's memory, and the memory plan assumes that none of them is reused.
void clear_pages(VolumeSource& source, const ConversionOptions& options) {
  constexpr std::uint64_t kTimes = 5;
  ReusedPages& pages = ReusedPages::of_process();
  const std::uint64_t needed = resident_bytes() + kTimes * pages.held_bytes();
  if (!reuses_pages(source, options) || needed > options.memory) pages.clear();
}

// Whether memory that the process holds already counts towards options.memory.
enum class Held { by_the_process, by_nobody };

// The source, the options and the outputs of a conversion.
struct Conversion {
  VolumeSource& source;
  const ConversionOptions& options;
  const ConversionControl& control;
  OutputFiles& output;
  WorkDirectory& work;
  Journal* journal;  // null: none
  Team& team;

  BlockCoder* coder() const { return source.resident() == nullptr ? control.coder : nullptr; }
};

// Sets `aim`, what the survey looks for in packed blocks. If a look ahead tells what the file will need, the survey
// looks for no more than that.
void aim_ladders(const Conversion& conversion, const ReadingPlan& reading, SurveyStores& stores,
                 const StreamOptions& stream, LadderAim& aim) {
  Journal* const journal = conversion.journal;
  LadderState& state = journal == nullptr ? stores.ladders : journal->state.ladders;
  const bool begun = journal != nullptr && !journal->state.survey.done.empty();
  if (!state.decided && !begun) {
    if (const auto outlook = look_ahead(conversion.source, reading, stores.rows, conversion.options, aim, stream)) {
      state = decided_by(*outlook);
      state.built = true;
    }
  }
  if (state.decided && state.built) {
    aim.near = state.near;
    aim.window = state.window();
  }
  aim.coder = conversion.coder();
}

// Surveys and writes the volume on `threads` threads. `workers` is the choice that was made before the system was asked
// how many threads it lets start.
Sidecar convert_on(std::size_t threads, const Workers& workers, const Conversion& conversion,
                   std::chrono::steady_clock::time_point started) {
  VolumeSource& source = conversion.source;
  const ConversionOptions& options = conversion.options;
  const ConversionControl& control = conversion.control;
  WorkDirectory& work = conversion.work;
  Journal* const journal = conversion.journal;
  Team& team = conversion.team;
  const SourceInfo& info = source.info();
  const Box domain = info.domain();
  MemoryShares shares;
  team.run(
      [&] { shares = share_memory(source, options, workers.resident, threads, journal == nullptr && team.alone()); });
  const MemoryPlan& memory = shares.memory;
  const ReadingPlan& reading = shares.reading;
  if (memory.record_bytes > 0) {
    using PagesOf = MemoryFileSystem::PagesOf;
    work.hold_records(reuses_pages(source, options) ? PagesOf::earlier_files : PagesOf::the_system);
  }
  if (journal == nullptr && team.alone() && threads == workers.threads) {
    reserve_ahead(conversion.output, options, control, source);
  }
  StreamOptions stream = stream_options(control);
  // More than two buffers help the survey, whose blocks are smaller, and let two threads read. If fewer threads can be
  // started than were chosen, one thread reads.
  if (threads == workers.threads) stream.buffer_bytes = 2 * memory.block_bytes;
  if (reading.encode.amplification > 1 && control.notice) {
    control.notice(amplification_notice(source, memory, options.memory, reading.encode));
  }

  // Survey.
  const auto voxels = static_cast<std::uint64_t>(domain.voxels());
  const NodeLattice& leaves = reading.survey.lattice;
  const std::optional<Visibility> visibility =
      visibility_of(options, source.places() == nullptr ? domain : source.places()->origin_domain());
  const auto spill = [&](const char* name) -> std::shared_ptr<File> {
    if (journal != nullptr) return journal->open(name);
    return work.spill_records();
  };
  std::optional<LadderAim> ladders = surveyed_ladders(options, info);
  SurveyStores stores =
      make_survey_stores(spill, leaves, memory.selection, visibility.has_value(), ladders.has_value(), team);
  if (journal != nullptr) forget_damaged(*journal, stores, ladders);
  SurveyState from_nothing;
  SurveyState& surveyed = journal == nullptr ? from_nothing : journal->state.survey;
  Pauses pauses;
  if (journal != nullptr) {
    pauses = {[&] { return journal->due(); }, [&] { journal->save(); }};
    if (journal->resumable() && control.notice) {
      control.notice(continued_notice(options.output, journal->state, leaves.size()));
    }
  }
  team.run([&] { start_pass(control, "survey", voxels - voxels_of(surveyed.done, reading.survey)); });
  if (ladders) aim_ladders(conversion, reading, stores, stream, *ladders);
  if (shares.cache_bytes > 0 && voxels_of(surveyed.done, reading.survey) < voxels) {
    stores.rows.set_cache(LeafCache::where_there_is_room(leaves, shares.cache_bytes));
  }
  const Survey survey = [&] {
    const TraceSpan span(control.trace, "survey pass", voxels * sizeof(float));
    return survey_volume(source, reading.survey, stores.rows, stream,
                         {reading.reading, surveys_widths(options), stores.faces ? &*stores.faces : nullptr, &surveyed,
                          pauses, ladders});
  }();
  check_source(source, team);  // before an encode pass is spent on it
  return convert_surveyed({source, options, control, conversion.output, work, journal, visibility}, reading, survey,
                          stores, started);
}

// Does the whole conversion except the clean-up after an error.
Sidecar convert_to(const Conversion& conversion, Held counted) {
  const ForkGuard forks;
  const ConversionOptions& options = conversion.options;
  const Notice& notice = conversion.control.notice;
  clear_pages(conversion.source, options);
  const std::uint64_t held = counted == Held::by_the_process ? resident_bytes() : 0;
  const auto started = std::chrono::steady_clock::now();
  say_axes(conversion.source.info(), notice);
  const Workers workers = choose_workers(conversion.source, options, conversion.coder(), held);
  if (options.threads == 0 && workers.threads < workers.processors && notice) {
    notice(fewer_threads_notice(workers.threads, workers.processors, options.memory));
  }
  std::size_t threads = workers.threads;
  conversion.team.run([&] { threads = startable_workers(workers.threads, notice); });
  return OwnThreads(threads).run([&] { return convert_on(threads, workers, conversion, started); });
}

// Checks a volume that weir wrote against its certificate. Throws as refuse_damaged() does.
void check_certified(const SourceInfo& info, const ConversionControl& control) {
  if (info.format != "nanovdb") return;
  DamageWatch watch;
  watch.notice = control.notice;
  watch.started = [&](std::uint64_t bytes) {
    check_cancel(control);
    if (control.pass_started) control.pass_started("check", bytes);
  };
  watch.advanced = [&](std::uint64_t done) {
    check_cancel(control);
    if (control.pass_advanced) control.pass_advanced(done);
  };
  refuse_damaged(info.path, watch);
}

}  // namespace

Sidecar convert_volume(VolumeSource& source, const ConversionOptions& options, const ConversionControl& control,
                       FileSystem& files, Team& team) {
  require_not_input(source_file_ids(source.info()), options.output);
  if (team.alone() && !options.overwrite) clear_after_commit(files, options.output);
  OutputFiles output(files, options.output, options.overwrite);
  WorkDirectory work(files, options.output, options.work_dir);
  std::unique_ptr<Journal> journal;
  // A team has no journal. With Resume::off, which the MPI program sets, open_journal() returns none and removes
  // the files that an interrupted conversion left.
  if (team.alone() || options.resume == Resume::off) {
    journal = open_journal(source.info(), options, control, output, files);
  }
  std::vector<std::string> begun =
      journal ? journal->paths() : std::vector<std::string>{hidden_directory_of(options.output)};
  begun.push_back(partial_path(options.output));  // the lock last: the process that gets it may begin
  const Hdf5CrashRemoval at_crash(std::move(begun));
  try {
    team.lead([&] { check_certified(source.info(), control); });
    Sidecar sidecar = convert_to({source, options, control, output, work, journal.get(), team}, Held::by_the_process);
    if (journal) journal->discard();
    return sidecar;
  } catch (const Error& error) {
    const Error cause = with_its_cause(error, source.info());
    if (output.committed()) {  // there is nothing to continue
      if (journal) journal->discard();
      throw cause;
    }
    throw journal ? ended_with(cause, *journal) : cause;
  }
}

Sidecar convert_into(OutputFiles& output, WorkDirectory& work, VolumeSource& source, const ConversionOptions& options,
                     const ConversionControl& control, Team& team) {
  return convert_to({source, options, control, output, work, nullptr, team}, Held::by_nobody);
}

}  // namespace weir
