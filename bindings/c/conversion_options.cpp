#include "bindings/c/conversion_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "bindings/c/status.h"
#include "bindings/c/versioned_struct.h"
#include "compressor/build_commit.h"
#include "format/base/text.h"

namespace weir::c {
namespace {

constexpr std::uint64_t kDefaultMemory = std::uint64_t{512} << 20U;
constexpr std::uint64_t kMaxMemory = std::uint64_t{1} << 50U;
constexpr std::int32_t kMaxThreads = 4096;
constexpr std::size_t kMaxNameBytes = 255;

constexpr std::array kTypes{ScalarType::uint8,   ScalarType::int8,    ScalarType::uint16, ScalarType::int16,
                            ScalarType::uint32,  ScalarType::int32,   ScalarType::uint64, ScalarType::int64,
                            ScalarType::float16, ScalarType::float32, ScalarType::float64};
static_assert(WEIR_UINT8 == 1 && WEIR_FLOAT64 == kTypes.size());
constexpr std::array kEncodings{Encoding::automatic, Encoding::float32, Encoding::fpn,
                                Encoding::fp4,       Encoding::fp8,     Encoding::fp16};
constexpr std::array kMetrics{Metric::sse, Metric::farthest, Metric::closest, Metric::median};
constexpr std::array kFills{FillMode::mean, FillMode::background};
constexpr std::array kPolicies{NonFinitePolicy::error, NonFinitePolicy::background, NonFinitePolicy::keep};

/// The choice that `value`, from `first` on, stands for.
template <typename T, std::size_t N>
T choice(std::string_view member, std::int32_t value, const std::array<T, N>& choices, std::int32_t first = 0) {
  const auto last = first + static_cast<std::int32_t>(N) - 1;
  if (value < first || value > last) throw usage(cat(member, " is ", value, ", it must be ", first, " to ", last));
  return choices[static_cast<std::size_t>(value - first)];
}

void require_zero(std::string_view member, double value, std::string_view what) {
  if (value != 0) throw usage(cat(member, " is ", value, ", and budget_kind is not ", what, "; set one or the other"));
}

double in_range(double value, double lo, double hi, std::string_view what) {
  if (!(value >= lo && value <= hi)) throw usage(cat("budget is ", value, ", ", what));
  return value;
}

Budget read_budget(const weir_convert_options& o) {
  const Budget::Kind kind = choice("budget_kind", o.budget_kind,
                                   std::array{Budget::Kind::automatic, Budget::Kind::rate, Budget::Kind::size,
                                              Budget::Kind::psnr, Budget::Kind::max_error, Budget::Kind::lossless});
  Budget budget;
  budget.kind = kind;
  if (kind == Budget::Kind::rate) {
    budget.rate = in_range(o.budget, 0x1p-20, 0x1p60, "a rate must be 2^-20 to 2^60: float32 bytes / file bytes");
  } else if (kind == Budget::Kind::psnr) {
    budget.target = in_range(o.budget, -1000, 1000, "a PSNR must be -1000 to 1000 dB");
  } else if (kind == Budget::Kind::max_error) {
    budget.target = in_range(o.budget, 0, 1e300, "a largest error must be 0 to 1e300, in the values' own unit");
  } else {
    require_zero("budget", o.budget, "WEIR_BUDGET_RATE, _PSNR or _MAX_ERROR");
  }
  if (kind == Budget::Kind::size) {
    if (o.size == 0) throw usage("size is 0, with WEIR_BUDGET_SIZE it must be the file's bytes");
    budget.bytes = o.size;
  } else {
    require_zero("size", static_cast<double>(o.size), "WEIR_BUDGET_SIZE");
  }
  return budget;
}

std::string exact(double value) { return stored_value_text(StoredValue{value}); }

/// What a command line would have said: the record in the sidecar.
std::map<std::string, std::string> recorded_options(const ConversionOptions& options) {
  std::map<std::string, std::string> record;
  switch (options.budget.kind) {
    case Budget::Kind::automatic:
      break;
    case Budget::Kind::rate:
      record["rate"] = exact(options.budget.rate);
      break;
    case Budget::Kind::size:
      record["size"] = cat(options.budget.bytes);
      break;
    case Budget::Kind::psnr:
      record["psnr"] = exact(options.budget.target);
      break;
    case Budget::Kind::max_error:
      record["max-error"] = exact(options.budget.target);
      break;
    case Budget::Kind::lossless:
      record["lossless"] = "true";
      break;
  }
  record["encoding"] = encoding_name(options.encoding);
  record["metric"] = metric_name(options.metric);
  record["fill"] = fill_name(options.fill);
  record["nonfinite"] = policy_name(options.non_finite);
  if (options.metric != Metric::sse) record["brick"] = cat(options.brick);
  if (options.background) record["background"] = exact(static_cast<double>(*options.background));
  return record;
}

bool all_zero(const double (&triple)[3]) { return triple[0] == 0 && triple[1] == 0 && triple[2] == 0; }
bool all_zero(const std::int64_t (&triple)[3]) { return triple[0] == 0 && triple[1] == 0 && triple[2] == 0; }
Index3 index_of(const std::int64_t (&triple)[3]) { return {triple[0], triple[1], triple[2]}; }
std::array<double, 3> array_of(const double (&triple)[3]) { return {triple[0], triple[1], triple[2]}; }

std::optional<StoredValue> read_missing(const char* text) {
  if (text == nullptr) return std::nullopt;
  const auto value = parse_stored_value(text);
  if (!value) throw usage(cat("missing is \"", text, "\", it must be a number or nan"));
  return value;
}

}  // namespace

DenseArray read_volume(const weir_volume* given) {
  const weir_volume volume = read_struct(given, "weir_volume");
  DenseArray array;
  array.type = choice("type", volume.type, kTypes, WEIR_UINT8);
  array.extent = index_of(volume.extent);
  if (!all_zero(volume.spacing)) array.spacing = array_of(volume.spacing);
  array.origin = array_of(volume.origin);
  if (volume.name != nullptr) array.name = volume.name;
  if (array.name.size() > kMaxNameBytes) {
    throw usage(cat("name has ", array.name.size(), " bytes, a grid's has at most ", kMaxNameBytes));
  }
  if (const auto missing = read_missing(volume.missing)) array.missing = {*missing};
  if (volume.reserved != 0) throw usage(cat("reserved is ", volume.reserved, ", it must be 0"));
  return array;
}

weir_convert_options options_or_defaults(const weir_convert_options* options) {
  if (options != nullptr) return read_struct(options, "weir_convert_options");
  weir_convert_options defaults;
  init_struct(&defaults, sizeof defaults);
  return defaults;
}

ConversionOptions read_options(const weir_convert_options& o) {
  ConversionOptions options;
  options.budget = read_budget(o);
  options.encoding = choice("encoding", o.encoding, kEncodings);
  options.metric = choice("metric", o.metric, kMetrics);
  options.fill = choice("fill", o.fill, kFills);
  options.non_finite = choice("nonfinite", o.nonfinite, kPolicies);
  options.brick = o.brick == 0 ? 8 : o.brick;
  if (options.brick != 8 && options.brick != 16 && options.brick != 32) {
    throw usage(cat("brick is ", o.brick, ", it must be 8, 16 or 32"));
  }
  if (options.metric == Metric::sse && options.brick != 8) {
    throw usage(cat("brick is ", o.brick, ", and WEIR_METRIC_SSE chooses single leaves; leave it 0"));
  }
  if (options.metric != Metric::sse && options.budget.by_error()) {
    throw usage(cat("metric is ", o.metric, ", and error budgets select by WEIR_METRIC_SSE"));
  }
  if (o.has_background != 0) {
    if (!std::isfinite(o.background)) throw usage(cat("background is ", o.background, ", it must be finite"));
    options.background = o.background;
  } else if (o.background != 0) {
    throw usage(cat("background is ", o.background, ", and has_background is 0; set it"));
  }
  options.overwrite = o.overwrite != 0;
  if (o.threads < 0 || o.threads > kMaxThreads) {
    throw usage(cat("threads is ", o.threads, ", it must be 0 to ", kMaxThreads));
  }
  options.threads = static_cast<std::size_t>(o.threads);
  if (o.memory > kMaxMemory) throw usage(cat("memory is ", o.memory, " bytes, it must be at most 2^50"));
  options.memory = o.memory == 0 ? kDefaultMemory : o.memory;
  if (o.work_dir != nullptr) options.work_dir = o.work_dir;
  options.provenance = {WEIR_VERSION, build_commit(), recorded_options(options)};
  return options;
}

SourceOptions read_input_options(const weir_input_options* given) {
  SourceOptions options;
  if (given == nullptr) return options;
  const weir_input_options o = read_struct(given, "weir_input_options");
  if (!all_zero(o.extent)) options.extent = index_of(o.extent);
  if (o.offset != 0) options.offset = o.offset;
  if (o.dataset != nullptr) options.dataset = o.dataset;
  if (o.index_count > 0) {
    constexpr std::size_t kMaxAxes = 32;  // HDF5 has no more
    if (o.index_count > kMaxAxes) throw usage(cat("index_count is ", o.index_count, ", it must be at most ", kMaxAxes));
    const std::int64_t* const index = required(o.index, "index");
    options.index.assign(index, index + o.index_count);
    for (const std::int64_t i : options.index) {
      if (i < 0) throw usage(cat("index has ", i, ", each must be 0 or more"));
    }
  }
  options.missing = read_missing(o.missing);
  if (!all_zero(o.spacing)) options.spacing = array_of(o.spacing);
  if (o.has_origin != 0) {
    options.origin = array_of(o.origin);
  } else if (!all_zero(o.origin)) {
    throw usage("origin is set, and has_origin is 0; set it");
  }
  if (!all_zero(o.roi_min) || !all_zero(o.roi_max)) options.roi = Box{index_of(o.roi_min), index_of(o.roi_max)};
  if (o.type != 0) options.type = choice("type", o.type, kTypes, WEIR_UINT8);
  options.big_endian = choice("endian", o.endian, std::array<std::optional<bool>, 3>{std::nullopt, false, true});
  options.stack = o.stack != 0;
  return options;
}

std::string checked_output(const char* path) {
  std::string output = required(path, "output");
  if (output.empty()) throw usage("output is empty; name a file");
  std::error_code ignored;
  if (std::filesystem::is_directory(output, ignored)) {
    throw usage(cat(output, ": is a directory; name a file in it as output"));
  }
  return output;
}

ConversionControl Callbacks::control() {
  ConversionControl control;
  control.cancel = &cancelled_;
  control.pass_started = [this](const std::string& pass, std::uint64_t total) { start(pass, total); };
  control.pass_advanced = [this](std::uint64_t done) { advance(done); };
  if (options_.notice != nullptr) {
    control.notice = [this](const std::string& line) {
      const std::scoped_lock lock(mutex_);
      options_.notice(options_.user, line.c_str());
    };
  }
  return control;
}

void Callbacks::start(const std::string& pass, std::uint64_t total_bytes) {
  const std::scoped_lock lock(mutex_);
  pass_ = pass;
  total_bytes_ = total_bytes;
  if (options_.progress != nullptr) options_.progress(options_.user, pass_.c_str(), 0, total_bytes_);
  ask_cancel();
}

void Callbacks::advance(std::uint64_t done_bytes) {
  const std::scoped_lock lock(mutex_);
  // A push has no survey pass of its own, and may still read what it spooled in search of the background.
  if (options_.progress != nullptr && !pass_.empty()) {
    options_.progress(options_.user, pass_.c_str(), std::min(done_bytes, total_bytes_), total_bytes_);
  }
  ask_cancel();
}

void Callbacks::ask_cancel() {
  if (options_.cancel != nullptr && options_.cancel(options_.user) != 0) cancelled_ = true;
}

}  // namespace weir::c
