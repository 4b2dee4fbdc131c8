#include "compressor/forecast/forecast.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "compressor/forecast/sample_plan.h"
#include "compressor/forecast/sample_scale.h"
#include "compressor/forecast/sampled_source.h"
#include "compressor/forecast/scratch_file_system.h"
#include "compressor/forecast/spread.h"
#include "compressor/plan/memory_plan.h"
#include "compressor/plan/reading_plan.h"
#include "compressor/resume/work_directory.h"
#include "compressor/select/file_size.h"
#include "compressor/select/fixed_bytes.h"
#include "compressor/surveyed_conversion.h"
#include "format/base/error.h"
#include "format/base/process_memory.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/layout/tree_layout.h"
#include "format/nanovdb/macrocells.h"
#include "format/output/output_files.h"

namespace weir {
namespace {

/// A conversion that left nothing.
struct Trial {
  Sidecar sidecar;
  double seconds = 0;
  std::uint64_t scratch_bytes = 0;
  std::int64_t voxels_read = 0;
  SampledNodes nodes;  ///< of regions that vary
};

double range_db(const Sidecar& s) { return 20 * std::log10(s.value_range[1] - s.value_range[0]); }

class Forecaster {
 public:
  Forecaster(VolumeSource& source, const ConversionOptions& options, const ConversionControl& control,
             FileSystem& files, std::uint64_t most_bytes)
      : source_(source),
        options_(options),
        control_(control),
        files_(files),
        domain_(source.info().domain()),
        most_voxels_(static_cast<std::int64_t>(most_bytes / sizeof(float))),
        plan_(domain_, source.access(), most_voxels_, options.metric == Metric::sse ? 1 : options.brick / kLeafDim) {}

  Forecast run() {
    check_places();
    plan_machine();
    forecast_.whole = plan_.whole();
    forecast_.volume_bytes = static_cast<std::uint64_t>(domain_.voxels()) * source_.access().bytes_per_voxel;
    forecast_.on_device = control_.coder != nullptr;
    expect_asked_bytes();
    if (can_sample()) sample();
    check_room();
    return forecast_;
  }

 private:
  // What a conversion refuses before it reads. Of a small volume its own checks come again.
  void check_places() {
    visibility_of(options_, domain_);
    ScratchFileSystem scratch(files_, options_.output);
    const OutputFiles output(scratch, options_.output, options_.overwrite);
    const WorkDirectory work(scratch, options_.output, options_.work_dir);
    spills_beside_ = work.path() == hidden_directory_of(options_.output);
    spill_directory_ = spills_beside_ ? directory_of(options_.output) : work.path();
  }

  // As conversion.cpp divides the machine.
  void plan_machine() {
    const std::size_t processors = processors_or_all(options_.processors);
    const std::uint64_t coding = control_.coder == nullptr ? 0 : control_.coder->host_bytes();
    const std::uint64_t resident = resident_bytes() + source_.working_bytes() + coding;
    const std::uint64_t of_region = region_bytes(options_);
    const std::size_t threads =
        choose_threads(options_.threads, processors, options_.memory, resident, domain_, of_region);
    const MemoryPlan memory = plan_memory(options_.memory, resident, threads, domain_, of_region);
    const ReadingPlan reading = plan_reading(source_, memory);
    if (reading.encode.amplification > 1 && control_.notice) {
      control_.notice(amplification_notice(source_, memory, options_.memory, reading.encode));
    }
    const std::uint64_t block = std::max(reading.survey.block_bytes, reading.encode.block_bytes);
    const std::uint64_t blocks = block * (reading.reading == Reading::in_place ? threads : 2);
    const std::uint64_t walk = threads * static_cast<std::uint64_t>(memory.segment_regions) * of_region;
    forecast_.threads = threads;
    forecast_.memory_bytes = std::min(options_.memory, memory.fixed_bytes + std::max(blocks, walk));
  }

  // The default is a rate for all volumes that are not small.
  void expect_asked_bytes() {
    const Budget& budget = options_.budget;
    const bool asked = budget.by_size() || (budget.kind == Budget::Kind::automatic && !plan_.whole());
    if (!asked || budget.at_most) return;
    const auto dense = static_cast<std::uint64_t>(domain_.voxels()) * sizeof(float);
    const auto bytes = static_cast<double>(asked_bytes(budget, dense));
    forecast_.exact_bytes = true;
    forecast_.file_bytes = {bytes, bytes, bytes};
  }

  bool can_sample() {
    const std::int64_t most = std::max(most_voxels_, domain_.voxels() / 20);
    if (plan_.whole() || plan_.domain().voxels() <= most) return true;
    forecast_.not_sampled = "its chunks are too large for a sample";
    return false;
  }

  void sample() {
    Trial trial;
    const SampleScale scale(domain_, plan_.domain(), options_, {region_count(domain_), region_count(plan_.domain())});
    try {
      trial = convert(plan_, scale);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::budget || forecast_.whole || !forecast_.exact_bytes) throw;
      refuse_hopeless_size();
      forecast_.not_sampled = "a sample is too small for a file of this rate";
      return;
    }
    describe_work(trial, scale.share());
    refuse_values(trial.sidecar);
    if (forecast_.whole) return describe_file(trial.sidecar, scale);
    // Only now it is known which regions have nodes.
    const double budget = static_cast<double>(scale.budget().bytes);
    const SampleScale better(domain_, plan_.domain(), options_, trial.nodes);
    const bool other = std::abs(static_cast<double>(better.budget().bytes) - budget) > budget / 500;
    const Sidecar again = other ? convert(plan_, better).sidecar : trial.sidecar;
    describe_file(again, better);
    add_spread(again, trial.nodes);
  }

  // The same as a conversion of the volume, but that it leaves nothing and that a sample has its own budget.
  Trial convert(const SamplePlan& plan, const SampleScale& scale) {
    ConversionOptions options = options_;
    options.resume = Resume::off;
    ConversionControl control;
    control.cancel = control_.cancel;
    control.coder = control_.coder;
    control.pass_started = control_.pass_started;
    control.pass_advanced = control_.pass_advanced;
    if (plan.whole()) {
      // What nobody asked for is said of a file that was written.
      if (options_.budget.kind != Budget::Kind::automatic) control.notice = control_.notice;
    } else {
      options.budget = scale.budget();
      options.scene.reset();  // places of a sample are not where they are seen
      if (options.non_finite == NonFinitePolicy::error) options.non_finite = NonFinitePolicy::background;
      if (options.missing == MissingPolicy::error) options.missing = MissingPolicy::background;
    }
    ScratchFileSystem scratch(files_, options.output);
    SampledSource source(source_, plan);
    const auto started = std::chrono::steady_clock::now();
    Trial trial;
    trial.sidecar = convert_volume(source, options, control, scratch);
    trial.seconds = seconds_since(started);
    trial.scratch_bytes = scratch.spilled_bytes();
    trial.voxels_read = source.voxels_read();
    trial.nodes = {source.varied_in_volume(), source.varied_in_sample()};
    return trial;
  }

  void describe_work(const Trial& trial, double share) {
    const Sidecar& s = trial.sidecar;
    Forecast& f = forecast_;
    f.sampled_voxels = static_cast<std::uint64_t>(plan_.domain().voxels());
    f.places = plan_.places();
    f.passes = static_cast<double>(trial.voxels_read) / static_cast<double>(f.sampled_voxels);
    f.read_bytes = static_cast<std::uint64_t>(static_cast<double>(s.timing.bytes_read) / share);
    f.scratch_bytes = static_cast<std::uint64_t>(static_cast<double>(trial.scratch_bytes) / share);
    f.survey_s = s.timing.survey_s / share;
    f.encode_s = (trial.seconds - s.timing.survey_s) / share;
  }

  void describe_file(const Sidecar& s, const SampleScale& scale) {
    Forecast& f = forecast_;
    const bool plain = s.grid.type == grid_type_name(GridType::float32);
    f.budget = s.budget.kind;
    f.encoding = s.packed ? encoding_name(Encoding::packed) : plain ? encoding_name(Encoding::float32) : s.grid.type;
    f.lossless = s.error.lossless;
    f.rmse = s.error.rmse;
    f.max_abs = s.error.max_abs;
    f.value_low = s.value_range[0];
    f.value_high = s.value_range[1];
    if (s.error.psnr_db) f.psnr_db = Expected{*s.error.psnr_db, *s.error.psnr_db, *s.error.psnr_db};
    if (f.whole) f.exact_bytes = true;
    if (f.exact_bytes && !f.whole) return;
    const double bytes = scale.file_bytes(s);
    f.file_bytes = {bytes, bytes, bytes};
  }

  // By conversions of parts of the sample.
  void add_spread(const Sidecar& s, const SampledNodes& nodes) {
    const std::vector<SamplePlan> plans = plan_.parts();
    const double open = static_cast<double>(nodes.of_sample) / static_cast<double>(region_count(plan_.domain()));
    std::vector<double> bytes;
    std::vector<double> db;
    double wider_db = 0;  // by which the sample's range is wider than its parts' are
    for (const SamplePlan& plan : plans) {
      const double regions = open * static_cast<double>(region_count(plan.domain()));
      const SampleScale scale(domain_, plan.domain(), options_,
                              {nodes.of_volume, static_cast<std::uint64_t>(std::llround(regions))});
      const Sidecar part = convert(plan, scale).sidecar;
      bytes.push_back(scale.file_bytes(part));
      if (part.error.psnr_db) db.push_back(*part.error.psnr_db);
      wider_db += (range_db(s) - range_db(part)) / static_cast<double>(plans.size());
    }
    forecast_.parts = plans.size();
    if (plans.empty()) return;
    const double share = SampleScale(domain_, plan_.domain(), options_, nodes).share();
    if (!forecast_.exact_bytes) forecast_.file_bytes = spread_of(forecast_.file_bytes.value, bytes, share);
    if (!s.error.psnr_db || db.size() < plans.size()) return;
    forecast_.psnr_db = spread_of(*s.error.psnr_db, db, share);
    if (options_.budget.by_error() || !std::isfinite(wider_db)) return;
    // The volume's range is at least the sample's. If it grows with each doubling as it did from the parts to the
    // sample, the PSNR is higher by as much.
    const double doublings = std::log2(static_cast<double>(plans.size()));
    forecast_.psnr_db->high += std::max(0.0, wider_db) / doublings * -std::log2(share);
  }

  // A conversion would, of the same values.
  void refuse_values(const Sidecar& s) const {
    const std::uint64_t sampled = forecast_.sampled_voxels;
    if (options_.non_finite == NonFinitePolicy::error && s.nonfinite.count > 0) {
      throw input_error(s.source.path,
                        compose(s.nonfinite.count, " of the ", sampled, " voxels sampled are NaN or infinite; choose ",
                                option("nonfinite", "background"), " or ", option("nonfinite", "keep")));
    }
    if (missing_policy_name(options_) == "error" && s.missing.count > 0) {
      throw input_error(s.source.path,
                        compose(s.missing.count, " of the ", sampled, " voxels sampled hold no data; choose ",
                                option("missing-policy", "background"), " or, to take them for data, ",
                                option("missing-policy", "keep")));
    }
  }

  // Of no volume of this extent a file is shorter.
  void refuse_hopeless_size() const {
    NodeCounts counts;
    counts.root_tiles = 1;
    counts.macrocells = static_cast<std::uint64_t>(make_lattice(domain_, kMacrocell).size());
    const std::uint64_t least = make_layout(counts).content_end;
    const auto asked = static_cast<std::uint64_t>(forecast_.file_bytes.value);
    if (asked >= least) return;
    throw Error(ErrorKind::budget, compose(options_.output, ": ", asked, " bytes asked, a file of this volume takes ",
                                           least, " besides its tree; ask for more with ", option("size")));
  }

  void check_room() const {
    const auto file = static_cast<std::uint64_t>(forecast_.file_bytes.value);
    const std::uint64_t beside = spills_beside_ ? forecast_.scratch_bytes : 0;
    require_room(directory_of(options_.output), file + beside);
    if (!spills_beside_) require_room(spill_directory_, forecast_.scratch_bytes);
  }

  void require_room(const std::string& directory, std::uint64_t bytes) const {
    const std::uint64_t free = files_.free_bytes(directory);
    if (bytes <= free) return;
    throw Error(ErrorKind::io,
                compose(options_.output, ": takes ", bytes, " bytes of ", directory, ", which has ", free, " free",
                        disk_full_remedy()),
                SystemFailure{ENOSPC, directory});
  }

  VolumeSource& source_;
  const ConversionOptions& options_;
  const ConversionControl& control_;
  FileSystem& files_;
  Box domain_;
  std::int64_t most_voxels_;
  SamplePlan plan_;
  bool spills_beside_ = true;
  std::string spill_directory_;
  Forecast forecast_;
};

}  // namespace

Forecast forecast_conversion(VolumeSource& source, const ConversionOptions& options, const ConversionControl& control,
                             FileSystem& files, std::uint64_t most_bytes) {
  return Forecaster(source, options, control, files, most_bytes).run();
}

}  // namespace weir
