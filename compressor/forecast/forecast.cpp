#include "compressor/forecast/forecast.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "compressor/conversion_memory.h"
#include "compressor/forecast/forecast_checks.h"
#include "compressor/forecast/read_probe.h"
#include "compressor/forecast/sample_copy.h"
#include "compressor/forecast/sample_plan.h"
#include "compressor/forecast/sample_scale.h"
#include "compressor/forecast/sampled_source.h"
#include "compressor/forecast/scratch_file_system.h"
#include "compressor/forecast/spread.h"
#include "compressor/forecast/trial.h"
#include "compressor/forecast/work_time.h"
#include "compressor/plan/memory_plan.h"
#include "compressor/plan/reading_plan.h"
#include "compressor/result_notices.h"
#include "compressor/resume.h"
#include "compressor/resume/work_directory.h"
#include "compressor/select/file_size.h"
#include "compressor/select/fixed_bytes.h"
#include "compressor/select/held_steps.h"
#include "compressor/select/leaf_gain.h"
#include "compressor/survey/visibility.h"
#include "compressor/surveyed_conversion.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"
#include "format/process/process_memory.h"

namespace weir {
namespace {

constexpr double kRateOfNoByte = 1e18;  // a compression rate that leaves no byte of any volume

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
    seen_ = visibility_of(options_, domain_);
    const OutputPlaces places(files_, options_);
    plan_machine();
    forecast_.whole = plan_.whole();
    forecast_.volume_bytes = static_cast<std::uint64_t>(domain_.voxels()) * source_.access().bytes_per_voxel;
    forecast_.on_device = control_.coder != nullptr;
    expect_asked_bytes();
    if (plan_.whole()) {
      try_volume();
    } else if (can_sample()) {
      try_sample();
    }
    places.require_room(static_cast<std::uint64_t>(forecast_.file_bytes.value), forecast_.scratch_bytes);
    return forecast_;
  }

 private:
  void plan_machine() {
    const Workers workers = choose_workers(source_, options_, control_.coder, resident_bytes());
    const std::size_t threads = workers.threads;
    const std::uint64_t of_region = region_bytes(options_);
    const bool keeps_work = is_resumable(source_.info(), options_, files_.is_memory(directory_of(options_.output)));
    const MemoryShares shares = share_memory(source_, options_, workers.resident, threads, !keeps_work);
    const MemoryPlan& memory = shares.memory;
    reading_ = shares.reading;
    if (reading_.encode.amplification > 1 && control_.notice) {
      control_.notice(amplification_notice(source_, memory, options_.memory, reading_.encode));
    }
    const std::uint64_t block = std::max(reading_.survey.block_bytes, reading_.encode.block_bytes);
    const std::uint64_t blocks = block * (reading_.reading == Reading::in_place ? threads : 2);
    const auto leaves = static_cast<std::uint64_t>(make_lattice(domain_, kLeafDim).size());
    const std::uint64_t steps =
        std::min(memory.selection.step_bytes, leaves * RegionGains::kMostSteps * sizeof(HeldSteps::Step));
    const std::uint64_t walk =
        threads * static_cast<std::uint64_t>(memory.selection.segment_regions) * of_region + steps;
    // Chunks are decoded whole. Rows can be read in smaller blocks at no cost.
    constexpr std::uint64_t kRowsBytes = std::uint64_t{32} << 20U;
    const bool chunked = source_.access().chunk != Index3{};
    copy_block_bytes_ = chunked ? memory.block_bytes : std::min(memory.block_bytes, kRowsBytes);
    forecast_.threads = threads;
    const std::uint64_t held = memory.record_bytes;
    cache_bytes_ = shares.cache_bytes;
    forecast_.memory_bytes =
        std::min(options_.memory, memory.fixed_bytes + held + std::max(blocks, walk) + cache_bytes_);
    forecast_.scratch_bytes = held > 0 ? 0 : record_bytes(options_, domain_);
  }

  // Returns whether the budget is a number of bytes. The default budget is a rate for all volumes that are not small.
  bool asks_bytes() const {
    const Budget& budget = options_.budget;
    return budget.by_size() || (budget.kind == Budget::Kind::automatic && !plan_.whole());
  }

  std::uint64_t bytes_asked() const { return asked_bytes(options_.budget, float32_bytes(domain_)); }

  void expect_asked_bytes() {
    if (!asks_bytes() || options_.budget.at_most) return;
    const auto bytes = static_cast<double>(bytes_asked());
    forecast_.exact_bytes = true;
    forecast_.file_bytes = {bytes, bytes, bytes};
  }

  bool can_sample() {
    const std::int64_t most = std::max(most_voxels_, domain_.voxels() / 20);
    if (plan_.domain().voxels() <= most) return true;
    forecast_.not_sampled = "its chunks are too large for a sample";
    return false;
  }

  ConversionControl trial_control() const {
    ConversionControl control;
    control.cancel = control_.cancel;
    control.coder = control_.coder;
    control.pads_file = !forecast_.exact_bytes;  // the padded file may be larger than the disk
    control.pass_started = control_.pass_started;
    control.pass_advanced = control_.pass_advanced;
    return control;
  }

  void try_volume() {
    ConversionControl control = trial_control();
    // Notices about the default budget speak of a file that was written, so the trial does not give them.
    const bool asked = options_.budget.kind != Budget::Kind::automatic;
    if (asked) control.notice = control_.notice;
    SampledSource source(source_, plan_);
    const Trial trial = run_trial(source, options_, control, files_);
    if (!asked) say_loss(trial.sidecar, options_, control_.notice);
    Forecast& f = forecast_;
    f.sampled_voxels = static_cast<std::uint64_t>(domain_.voxels());
    f.places = 1;
    f.passes = static_cast<double>(source.voxels_read()) / static_cast<double>(domain_.voxels());
    f.read_bytes = source.bytes_read();
    f.survey_s = trial.survey_s;
    f.encode_s = trial.encode_s;
    if (!f.exact_bytes) {
      const auto bytes = static_cast<double>(trial.sidecar.file.bytes);
      f.file_bytes = {bytes, bytes, bytes};
      f.exact_bytes = true;
    }
    describe_file(trial.sidecar);
  }

  void try_sample() {
    SampledSource sampled(source_, plan_, SampledSource::From::volume, seen_ ? &*seen_ : nullptr);
    ScratchFileSystem scratch(files_, options_.output);
    WorkDirectory work(scratch, options_.output, options_.work_dir);
    SampleCopy copy(sampled, work.spill(), copy_block_bytes_, control_.cancel);
    const auto voxels = static_cast<double>(plan_.domain().voxels());
    const ReadCost cost = reading_.reading == Reading::in_place
                              ? ReadCost{0, 0, static_cast<double>(sampled.bytes_read()) / voxels}
                              : probe_reading(source_, reading_.survey);
    const SampledNodes nodes{sampled.varied_in_volume(), sampled.varied_in_sample()};
    if (seen_) sampled.find_reaches(control_.cancel);
    const SampleScale scale(domain_, plan_.domain(), options_, nodes);
    const std::vector<Part> parts = try_parts(copy, nodes);
    const std::optional<Trial> all = try_all(copy, scale);
    if (!all) return;
    const Trial& trial = *all;
    forecast_.sampled_voxels = static_cast<std::uint64_t>(plan_.domain().voxels());
    forecast_.places = plan_.places();
    refuse_sampled_values(options_, trial.sidecar);
    describe_work(trial, parts, cost, sampled.varied_share());
    describe_file(trial.sidecar);
    const ConversionLoss& loss = copy.copied_loss();
    forecast_.loss = {loss.inexact, loss.overflow, loss.max_abs_error};
    if (!forecast_.exact_bytes) {
      const double bytes = scale.file_bytes(trial.sidecar);
      forecast_.file_bytes = {bytes, bytes, bytes};
    }
    add_spread(trial.sidecar, parts, scale.share());
  }

  // Converts the sample. Returns nullopt if the sample has no file of its share of the requested bytes; not_sampled
  // then says why.
  std::optional<Trial> try_all(SampleCopy& copy, const SampleScale& scale) {
    ConversionOptions options = sample_options(scale);
    try {
      return run_trial(copy, options, trial_control(), files_);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::budget || !asks_bytes()) throw;
    }
    const std::uint64_t asked = bytes_asked();
    refuse_hopeless_size(options_, domain_, asked);
    options.budget = {.kind = Budget::Kind::automatic, .rate = kRateOfNoByte};
    std::optional<Trial> smallest = run_trial(copy, options, trial_control(), files_);
    refuse_sampled_values(options_, smallest->sidecar);
    const auto least = static_cast<std::uint64_t>(std::llround(scale.file_bytes(smallest->sidecar)));
    if (least <= asked) {
      forecast_.not_sampled = "a sample is too small for a file of this rate";
      return std::nullopt;
    }
    if (options_.budget.kind == Budget::Kind::automatic) {
      forecast_.exact_bytes = false;
      return smallest;
    }
    // The volume has all blocks of its sample, so its file cannot be smaller than the sample's.
    if (smallest->sidecar.file.bytes > asked) refuse_size(options_, asked, least);
    forecast_.not_sampled = cat("by one, the smallest tree for this volume takes about ", least, " bytes");
    return std::nullopt;
  }

  // Returns the options for the sample, with its own budget and without policies that refuse values.
  ConversionOptions sample_options(const SampleScale& scale) const {
    ConversionOptions options = options_;
    options.budget = scale.budget();
    if (options.non_finite == NonFinitePolicy::error) options.non_finite = NonFinitePolicy::background;
    if (options.missing == MissingPolicy::error) options.missing = MissingPolicy::background;
    return options;
  }

  /// A conversion of a part of the sample.
  struct Part {
    Trial trial;
    double voxels = 0;
    double file_bytes = 0;  ///< bytes of the volume's file as this part predicts them
  };

  // Converts the parts of the sample. Returns no part if any of them is too small for its budget.
  std::vector<Part> try_parts(SampleCopy& copy, const SampledNodes& nodes) {
    const double open = static_cast<double>(nodes.of_sample) / static_cast<double>(region_count(plan_.domain()));
    std::vector<Part> parts;
    try {
      for (const SamplePlan& plan : plan_.parts()) {
        const double regions = open * static_cast<double>(region_count(plan.domain()));
        const SampleScale scale(domain_, plan.domain(), options_,
                                {nodes.of_volume, static_cast<std::uint64_t>(std::llround(regions))});
        SampledSource source(copy, plan, SampledSource::From::copy);
        Part part{run_trial(source, sample_options(scale), trial_control(), files_)};
        part.voxels = static_cast<double>(plan.domain().voxels());
        part.file_bytes = scale.file_bytes(part.trial.sidecar);
        parts.push_back(std::move(part));
      }
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::budget) throw;
      parts.clear();
    }
    return parts;
  }

  void describe_work(const Trial& trial, const std::vector<Part>& parts, const ReadCost& cost, double varied) {
    Forecast& f = forecast_;
    const auto sampled = static_cast<double>(plan_.domain().voxels());
    const auto voxels = static_cast<double>(domain_.voxels());
    // In the sample, places beside a place that is read again are read again too. In the volume, fewer places lie side
    // by side.
    const double again = static_cast<double>(trial.sidecar.timing.bytes_read) / (sizeof(float) * sampled) - 1;
    const double from_memory = std::min(1.0, static_cast<double>(cache_bytes_) / (sizeof(float) * varied * voxels));
    f.passes = 1 + (1 - from_memory) * std::clamp(std::ceil(again) * varied, 0.0, std::max(0.0, again));
    f.read_bytes = static_cast<std::uint64_t>(f.passes * cost.bytes * voxels);
    std::vector<double> survey_s;
    std::vector<double> encode_s;
    const double part_voxels = parts.empty() ? 0 : parts.front().voxels;
    if (are_like_volume(options_.encoding, part_voxels)) {
      for (const Part& part : parts) {
        survey_s.push_back(part.trial.survey_s);
        encode_s.push_back(part.trial.encode_s);
      }
    }
    f.survey_s =
        pass_time(scaled_time(trial.survey_s, sampled, survey_s, part_voxels, voxels), f.threads, voxels, cost);
    f.encode_s = pass_time(scaled_time(trial.encode_s, sampled, encode_s, part_voxels, voxels), f.threads,
                           (f.passes - 1) * voxels, cost);
  }

  void describe_file(const Sidecar& s) {
    Forecast& f = forecast_;
    const bool plain = s.grid.type == grid_type_name(GridType::float32);
    // The sample of a rate was converted with a size.
    const bool of_rate = s.budget.kind == "size" && options_.budget.kind != Budget::Kind::size;
    f.budget = of_rate ? "rate" : s.budget.kind;
    f.encoding = s.packed ? encoding_name(Encoding::packed) : plain ? encoding_name(Encoding::float32) : s.grid.type;
    f.error = without_spread(s.error);
    f.value_low = s.value_range[0];
    f.value_high = s.value_range[1];
    f.loss = s.conversion_loss;
    if (!s.visible) return;
    f.shown_voxels = s.visible->voxels;
    if (f.shown_voxels > 0) f.shown = without_spread(s.visible->error);
  }

  static ForecastError without_spread(const Sidecar::CertifiedError& error) {
    ForecastError expected{error.lossless, {}, error.rmse, error.max_abs};
    if (error.psnr_db) expected.psnr_db = Expected{*error.psnr_db, *error.psnr_db, *error.psnr_db};
    return expected;
  }

  void add_spread(const Sidecar& s, const std::vector<Part>& parts, double share) {
    forecast_.parts = parts.size();
    if (parts.empty()) return;
    std::vector<double> bytes;
    std::vector<double> db;
    std::vector<double> shown_db;
    double wider_db = 0;  // mean of how much wider the sample's range is than the range of a part
    for (const Part& part : parts) {
      const Sidecar& of_part = part.trial.sidecar;
      bytes.push_back(part.file_bytes);
      if (of_part.error.psnr_db) db.push_back(*of_part.error.psnr_db);
      if (of_part.visible && of_part.visible->error.psnr_db) shown_db.push_back(*of_part.visible->error.psnr_db);
      wider_db += (range_db(s) - range_db(of_part)) / static_cast<double>(parts.size());
    }
    if (!forecast_.exact_bytes) {
      forecast_.file_bytes = spread_of(forecast_.file_bytes.value, bytes, share);
      forecast_.file_bytes.low = std::max(0.0, forecast_.file_bytes.low);
    }
    // The volume's range is at least the sample's. If the range grows with each doubling as it did from the parts to
    // the sample, the PSNR rises by the same amount.
    const double doublings = std::log2(static_cast<double>(parts.size()));
    const double of_range = std::isfinite(wider_db) ? std::max(0.0, wider_db) / doublings * -std::log2(share) : 0;
    // How coarse hidden blocks become depends on whether their neighbours are hidden too. A sample mixes neighbours, so
    // that the parts do not tell the spread.
    if (!options_.scene) add_spread(forecast_.error, db, share, of_range);
    if (forecast_.shown) add_spread(*forecast_.shown, shown_db, share, of_range);
  }

  // Adds the spread of the PSNR. Adds none if some part has no error, or shows nothing of a scene.
  void add_spread(ForecastError& error, const std::vector<double>& of_parts_db, double share,
                  double of_range_db) const {
    if (!error.psnr_db || of_parts_db.size() < forecast_.parts) return;
    error.psnr_db = spread_of(error.psnr_db->value, of_parts_db, share);
    if (!options_.budget.by_error()) error.psnr_db->high += of_range_db;
  }

  VolumeSource& source_;
  const ConversionOptions& options_;
  const ConversionControl& control_;
  FileSystem& files_;
  Box domain_;
  std::int64_t most_voxels_;
  SamplePlan plan_;
  std::optional<Visibility> seen_;
  ReadingPlan reading_;
  std::uint64_t copy_block_bytes_ = 0;
  std::uint64_t cache_bytes_ = 0;  // bytes of the volume that the conversion caches in memory
  Forecast forecast_;
};

}  // namespace

Forecast forecast_conversion(VolumeSource& source, const ConversionOptions& options, const ConversionControl& control,
                             FileSystem& files, std::uint64_t most_bytes) {
  return Forecaster(source, options, control, files, most_bytes).run();
}

}  // namespace weir
