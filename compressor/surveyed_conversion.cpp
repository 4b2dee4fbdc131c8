#include "compressor/surveyed_conversion.h"

#include <tbb/parallel_invoke.h>

#include <future>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "compressor/conversion_control.h"
#include "compressor/conversion_identity.h"
#include "compressor/derived/derived_error.h"
#include "compressor/describe_conversion.h"
#include "compressor/encode/encode_attempts.h"
#include "compressor/encode/tree_writer.h"
#include "compressor/file_digest.h"
#include "compressor/outlook/budget_outlook.h"
#include "compressor/plan/own_threads.h"
#include "compressor/refused_values.h"
#include "compressor/result_notices.h"
#include "compressor/select/file_size.h"
#include "compressor/select/fixed_bytes.h"
#include "compressor/select/leaf_gain.h"
#include "compressor/select/leaf_reach.h"
#include "compressor/survey/background.h"
#include "compressor/survey/ladder_completion.h"
#include "compressor/surveyed_request.h"
#include "compressor/work_beside.h"
#include "format/base/error.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/layout/nvdb_type.h"
#include "format/output/written_volume.h"
#include "format/packed/block_coder.h"
#include "format/process/process_memory.h"
#include "ingest/files/file_state.h"

namespace weir {
namespace {

using Clock = std::chrono::steady_clock;

Background choose_background(const ConversionOptions& options, const Survey& survey, const RowStore& rows,
                             VolumeSource& source, const BlockPlan& plan, const StreamOptions& stream) {
  if (options.background) return {*options.background, "user", 0};
  if (options.paper_background) return paper_background(survey, source, plan, stream, rows.team());
  return find_background(survey, rows, source, plan, stream);
}

}  // namespace

std::optional<Visibility> visibility_of(const ConversionOptions& options, const Box& domain) {
  if (!options.scene) return std::nullopt;
  if (options.metric != Metric::sse) {
    throw Error(ErrorKind::usage,
                compose(option("scene"), " weighs squared errors, ", option("metric", metric_name(options.metric)),
                        " has none; use ", option("metric", "sse")));
  }
  const bool promise = options.budget.by_error() || options.budget.kind == Budget::Kind::lossless;
  return Visibility(options.scene->scene, options.scene->path, domain,
                    promise ? Visibility::Weighing::alike : Visibility::Weighing::by_picture);
}

void check_source(const VolumeSource& source, Team& team) {
  team.run([&] { check_unchanged(source.info().files); });
}

bool surveys_widths(const ConversionOptions& options) {
  return options.encoding != Encoding::float32 && options.encoding != Encoding::packed && options.metric == Metric::sse;
}

std::optional<LadderAim> surveyed_ladders(const ConversionOptions& options, const SourceInfo& source) {
  if (options.encoding != Encoding::packed) return std::nullopt;
  LadderAim aim;
  aim.lossless = options.budget.kind == Budget::Kind::lossless;
  if (options.budget.kind == Budget::Kind::max_error) aim.max_error = options.budget.target;
  aim.keeps_non_finite = options.non_finite == NonFinitePolicy::keep;
  aim.background = options.background;
  aim.lattice = lattice_of(source);
  aim.near_rungs = !aim.lattice && !aim.lossless && !aim.max_error;
  return aim;
}

namespace {

/// The stages of a conversion whose volume is surveyed, in the order in which they are called.
class SurveyedConversion {
 public:
  SurveyedConversion(const ConversionParts& parts, const ReadingPlan& reading, const Survey& survey,
                     SurveyStores& stores, Clock::time_point started)
      : parts_(parts),
        options_(parts.options),
        info_(parts.source.info()),
        reading_(reading),
        survey_(survey),
        stores_(stores),
        team_(stores.rows.team()),
        stream_(stream_options(parts.control)),
        started_(started),
        sidecar_(describe_source(info_, survey, options_)) {}

  Sidecar run() {
    memory_ =
        beside_resident([this](ResidentVolume& resident) { resident.expect_streams(region_count(info_.domain())); });
    FileRequest request = prepare();
    sidecar_.timing.survey_s = seconds_since(started_);
    const Clock::time_point encoding = Clock::now();
    EncodedFile encoded = encode(std::move(request));
    // Most of the file is written to the disk while the rest is made.
    const std::jthread writeback = start_beside([this] { parts_.output.volume().start_writeback(); });
    const std::jthread release = released(stores_.rows.give_up_cache());
    memory_ = beside_resident([](ResidentVolume& resident) { resident.free_memory(); });
    write_inner_nodes(encoded);
    if (source_digest_.valid()) sidecar_.source.digest = source_digest_.get();
    describe_file(sidecar_, info_, survey_, options_, background_, head_, encoded, shown_);
    say_result(sidecar_, options_, parts_.control.notice);
    digest(encoded);
    std::jthread unmap = released(std::move(encoded.mapped));
    sidecar_.timing.encode_s = seconds_since(encoding);
    if (options_.certify == Certify::gradient) {
      if (unmap.joinable()) unmap.join();  // there is no room for both
      certify_gradient();
    }
    commit(encoded);
    return sidecar_;
  }

 private:
  // Does `work` on a thread of its own if the volume lies on a device and is packed. Otherwise does nothing.
  template <class Work>
  std::jthread beside_resident(Work work) {
    ResidentVolume* const resident = parts_.source.resident();
    if (resident == nullptr || options_.encoding != Encoding::packed) return {};
    return start_beside([resident, work = std::move(work)] { work(*resident); });
  }

  // Returns the request with everything that selection needs.
  FileRequest prepare() {
    const TraceSpan span(parts_.control.trace, "background");
    prepare_source();
    FileRequest request = make_request();
    finish_ladders(request);
    return request;
  }

  // Throws if the options refuse a value. Finds the background and the source's digest at the same time, then saves.
  void prepare_source() {
    refuse_values(options_, survey_, info_);
    Journal* const journal = parts_.journal;
    const bool known = journal != nullptr && journal->state.background;
    const auto find = [&] {
      background_ = known ? *journal->state.background
                          : choose_background(options_, survey_, stores_.rows, parts_.source, reading_.survey, stream_);
    };
    const auto digest = [&] { sidecar_.source.digest = source_digest(stores_.rows); };
    if (team_.alone() && parts_.source.resident() != nullptr && stores_.rows.held() != nullptr) {
      // Takes one thread, beside those of --threads, as long as a device takes for half of the survey. Its digests of
      // pieces take 16 bytes a block, far less than the steps that selection plans beside rows in memory. Rows that are
      // not in memory would need memory that the selection has planned for itself.
      source_digest_ = std::async([this] { return OwnArena(1).run([&] { return source_digest(stores_.rows); }); });
      find();
    } else if (team_.alone()) {
      tbb::parallel_invoke(find, digest);
    } else {  // ranks must meet in the same order everywhere
      find();
      team_.lead(digest);
    }
    if (journal == nullptr) return;
    journal->state.background = background_;
    // Selection cannot be continued: this save keeps the last surveyed blocks if selection is interrupted. A short
    // conversion has no blocks to lose.
    if (journal->resumable()) journal->save();
  }

  // Builds the ladders that the survey could not build: of packed blocks that contain the background, and of blocks
  // that keep nearly everything. Sets the request's window.
  void finish_ladders(FileRequest& request) {
    std::optional<LadderAim> aim = surveyed_ladders(options_, info_);
    if (!aim) return;
    LadderState& state = ladders();
    if (aim->has_rungs() && !state.decided) state = decided_by(outlook_of(request, stores_.rows));
    if (aim->near_rungs && state.near != NearBlocks::none && !state.built) state.built = state.rebuilt = true;
    request.packed.window = state.window();
    if (state.short_of_preview && request.packed.preview == Preview::automatic) request.packed.preview = Preview::off;
    MissingLadders missing;
    missing.all = state.rebuilt;
    missing.filled = !aim->background && !aim->keeps_non_finite && survey_.missing + survey_.non_finite > 0;
    complete(*aim, missing);
  }

  // Called if the planned file's cut lies outside the request's window. The first call takes a window about `cut`;
  // later calls take none.
  void move_window(FileRequest& request, double cut) {
    LadderState& state = ladders();
    const auto window = state.moves++ == 0 ? KeyWindow::about(cut, state.width) : std::nullopt;
    state.centre = window ? std::optional(window->centre()) : std::nullopt;
    state.reach = KeyWindow::kMostReach;
    request.packed.window = window;
    if (!state.built) return;  // all rungs are there
    state.rebuilt = true;
    complete(*surveyed_ladders(options_, info_), {false, true});
  }

  void complete(LadderAim aim, const MissingLadders& missing) {
    if (!missing.all && !missing.filled) return;
    const LadderState& state = ladders();
    if (!aim.background) aim.background = background_.value;
    if (state.built) {
      aim.near = state.near;
      aim.window = state.window();
    }
    // A save before the rebuild: ladders that an earlier process saved must not be taken for the ones that are built
    // now.
    if (missing.all && parts_.journal != nullptr && parts_.journal->resumable()) parts_.journal->save_now();
    complete_ladders(parts_.source, reading_.survey, stores_.rows, aim, missing, stream_);
  }

  LadderState& ladders() { return parts_.journal == nullptr ? stores_.ladders : parts_.journal->state.ladders; }

  // Returns the request for the file. If a scene weighs errors, the rows also get what the scene shows of each leaf.
  FileRequest make_request() {
    FileRequest request = request_for(options_, survey_, info_, background_.value);
    request.pads_file = parts_.control.pads_file;
    request.packed = packed_request(options_, survey_, info_, request.rule.fill.background);
    if (parts_.seen) {
      shown_ = find_reaches(*stores_.faces, *parts_.seen, request.rule.fill, parts_.source.places(), parts_.work,
                            stores_.rows);
      stores_.faces.reset();
      request.rule.visibility = &*parts_.seen;
    }
    if (raises_default(options_, info_.domain())) request.budget.target = kDefaultLeastDb;
    request.squared_error = allowed_error(request.budget, survey_, parts_.seen ? shown_.finite : survey_.finite);
    return request;
  }

  // Selects and encodes leaves, repeatedly if the budget needs it.
  EncodedFile encode(FileRequest request) {
    check();
    const auto voxels = static_cast<std::uint64_t>(info_.domain().voxels());
    EncodedFile encoded = encode_file(
        {parts_.source, reading_.encode, reading_.reading, stores_.rows, parts_.work, parts_.output, parts_.journal,
         options_.scene ? visible_values(options_.scene->scene) : "", stream_, [&] { start_encoding(voxels); },
         parts_.control.notice, parts_.control.planned,
         [&](FileRequest& outside, double cut) { move_window(outside, cut); }, parts_.control.coder, options_.memory},
        std::move(request));
    const Message& notice = encoded.file.size.notice;
    // say_result() reports a lossless file that the default chose.
    const bool own_choice = options_.budget.kind == Budget::Kind::automatic && encoded.file.size.kind == "lossless";
    if (!notice.empty() && !own_choice && parts_.control.notice) parts_.control.notice(notice);
    return encoded;
  }

  void start_encoding(std::uint64_t voxels) {
    if (memory_.joinable()) memory_.join();
    team_.run([&] { start_pass(parts_.control, "encode", voxels); });
  }

  // Writes everything in the file except its leaves.
  void write_inner_nodes(const EncodedFile& encoded) {
    const TraceSpan span(parts_.control.trace, "write tree");
    check();
    const FilePlan& file = encoded.file;
    const GridType type = grid_type_of(file.encoding);
    head_.type = type;
    head_.grid_class = info_.grid_class;
    head_.breadth_first = type != GridType::fpn;
    head_.name = grid_name(info_.dataset);
    if (head_.name != info_.dataset && !info_.dataset.empty() && parts_.control.notice) {
      parts_.control.notice(cat(info_.path, ": a grid's name is UTF-8 of at most ", kMaxGridNameBytes,
                                " bytes, and its dataset's is not: the grid is called ", head_.name));
    }
    head_.voxel_size = info_.spacing;
    head_.origin = info_.origin;
    team_.lead([&] {
      checksum_ = encoded.regions ? encoded.regions->tree().finish(head_)
                                  : TreeWriter(tree_parts(encoded, stores_.rows), volume_of(encoded)).finish(head_);
    });
    team_.follow(checksum_);
    team_.publish(parts_.output.volume());
    check();
  }

  void digest(const EncodedFile& encoded) {
    const std::uint64_t bytes = encoded.file.size.bytes;
    const TraceSpan span(parts_.control.trace, "digest", bytes);
    // The digest is of the finished bytes: the hashed bytes are the ones that the file system holds.
    sidecar_.file = {bytes, encoded.file.plan.layout.grid, checksum_, digest_of_file(volume_of(encoded), team_).hex()};
  }

  File& volume_of(const EncodedFile& encoded) { return encoded.mapped ? *encoded.mapped : parts_.output.volume(); }

  // Measures the gradient's error in the file as it will be read. Dropped blocks, and the steps from one block to the
  // next, count too.
  void certify_gradient() {
    const auto voxels = static_cast<std::uint64_t>(info_.domain().voxels());
    const TraceSpan span(parts_.control.trace, "certify", voxels * sizeof(float));
    team_.run([&] { start_pass(parts_.control, "certify", voxels); });
    std::optional<WrittenVolume> written;
    team_.run([&] { written.emplace(parts_.output.volume()); });
    CompareOptions compare;
    compare.block_bytes = reading_.pair_bytes;
    compare.page_bytes = 2 * reading_.pair_bytes;
    compare.cancel = parts_.control.cancel;
    compare.progress = parts_.control.pass_advanced;
    compare.release_pages = [&] { written->release_pages(); };
    compare.trace = parts_.control.trace;
    sidecar_.gradient = gradient_error(parts_.source, written->grid(), compare, team_);
    check();
  }

  void commit(const EncodedFile& encoded) {
    sidecar_.timing.total_s = seconds_since(started_);
    sidecar_.timing.bytes_read = parts_.source.bytes_read();
    team_.sum<std::uint64_t>({&sidecar_.timing.bytes_read, 1});
    sidecar_.timing.bytes_written = encoded.file.plan.layout.content_end;
    sidecar_.timing.peak_rss_bytes = peak_resident_bytes();
    const TraceSpan span(parts_.control.trace, "commit", encoded.file.size.bytes);
    const std::string text = to_json_text(sidecar_);
    std::vector<char> record(text.begin(), text.end());
    team_.follow(record);  // times are the leading rank's
    check_source(parts_.source, team_);
    if (parts_.control.before_commit) team_.run(parts_.control.before_commit);
    parts_.output.commit({record.begin(), record.end()});
  }

  void check() const {
    team_.run([&] { check_cancel(parts_.control); });
  }

  const ConversionParts& parts_;
  const ConversionOptions& options_;
  const SourceInfo& info_;
  const ReadingPlan& reading_;
  const Survey& survey_;
  SurveyStores& stores_;
  Team& team_;
  const StreamOptions stream_;
  const Clock::time_point started_;
  Sidecar sidecar_;
  Background background_;
  Shown shown_;
  GridHead head_;
  std::uint32_t checksum_ = 0;
  std::future<std::string> source_digest_;  // if it is computed beside the selection
  std::jthread memory_;                     // allocates or frees the device's memory
};

}  // namespace

Sidecar convert_surveyed(const ConversionParts& parts, const ReadingPlan& reading, const Survey& survey,
                         SurveyStores& stores, Clock::time_point started) {
  return SurveyedConversion(parts, reading, survey, stores, started).run();
}

}  // namespace weir
