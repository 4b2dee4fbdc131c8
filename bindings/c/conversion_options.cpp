#include "bindings/c/conversion_options.h"

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

#include "bindings/c/status.h"
#include "bindings/c/versioned_struct.h"
#include "bindings/c/wording.h"
#include "compressor/build_commit.h"
#include "compressor/options/conversion_request.h"
#include "format/base/printable.h"
#include "format/base/scalar_type.h"
#include "format/base/utf8.h"
#include "format/nanovdb/grid_head.h"
#include "ingest/source/extent.h"

namespace weir::c {
namespace {

constexpr std::uint64_t kMaxMemory = std::uint64_t{1} << 50U;

constexpr std::array kTypes{ScalarType::uint8,   ScalarType::int8,    ScalarType::uint16,  ScalarType::int16,
                            ScalarType::uint32,  ScalarType::int32,   ScalarType::uint64,  ScalarType::int64,
                            ScalarType::float16, ScalarType::float32, ScalarType::float64, ScalarType::bfloat16};
static_assert(WEIR_UINT8 == 1 && WEIR_BFLOAT16 == kTypes.size());

void require_in(std::string_view member, std::int32_t value, std::int32_t first, std::size_t count) {
  const auto last = first + static_cast<std::int32_t>(count) - 1;
  if (value < first || value > last) throw usage(cat(member, " is ", value, ", it must be ", first, " to ", last));
}

/// Returns the choice of the option `key` for `value`: the enumerators of weir.h are in the order of the table.
std::string choice(std::string_view key, std::int32_t value) {
  const std::vector<std::string> choices = split(conversion_option(key).argument, '|');
  require_in(key_wording({std::string(key), {}}), value, 0, choices.size());
  return choices[static_cast<std::size_t>(value)];
}

ScalarType scalar_type(std::int32_t value) {
  require_in("type", value, WEIR_UINT8, kTypes.size());
  return kTypes.at(static_cast<std::size_t>(value - WEIR_UINT8));
}

void require_zero(std::string_view member, double value, std::string_view what) {
  if (value != 0) throw usage(cat(member, " is ", value, ", and budget_kind is not ", what, "; set one or the other"));
}

std::string exact(double value) { return stored_value_text(StoredValue{value}); }

void give_budget(const weir_convert_options& o, GivenOptions& given) {
  require_in("budget_kind", o.budget_kind, WEIR_BUDGET_AUTO, WEIR_BUDGET_LOSSLESS + 1);
  if (o.budget_kind == WEIR_BUDGET_RATE) given["rate"] = exact(o.budget);
  if (o.budget_kind == WEIR_BUDGET_PSNR) given["psnr"] = exact(o.budget);
  if (o.budget_kind == WEIR_BUDGET_MAX_ERROR) given["max-error"] = exact(o.budget);
  if (o.budget_kind == WEIR_BUDGET_LOSSLESS) given["lossless"] = "true";
  if (!given.contains("rate") && !given.contains("psnr") && !given.contains("max-error")) {
    require_zero("budget", o.budget, "WEIR_BUDGET_RATE, _PSNR or _MAX_ERROR");
  }
  if (o.budget_kind == WEIR_BUDGET_SIZE) {
    given["size"] = cat(o.size);
  } else {
    require_zero("size", static_cast<double>(o.size), "WEIR_BUDGET_SIZE");
  }
  if (o.at_most != 0) given["at-most"] = "true";
}

/// Returns the options as a command line would give them; the sidecar records them.
GivenOptions given_method(const weir_convert_options& o) {
  GivenOptions given;
  give_budget(o, given);
  given["encoding"] = choice("encoding", o.encoding);
  if (o.preview != WEIR_PREVIEW_AUTO) given["preview"] = choice("preview", o.preview);
  given["metric"] = choice("metric", o.metric);
  given["fill"] = choice("fill", o.fill);
  given["nonfinite"] = choice("nonfinite", o.nonfinite);
  if (o.missing_policy != WEIR_MISSING_POLICY_AUTO)
    given["missing-policy"] = choice("missing-policy", o.missing_policy);
  if (o.certify != WEIR_CERTIFY_VALUES) given["certify"] = choice("certify", o.certify);
  if (o.reserved != 0) throw usage(cat("reserved is ", o.reserved, ", it must be 0"));
  if (o.metric != WEIR_METRIC_SSE || (o.brick != 0 && o.brick != 8)) given["brick"] = cat(o.brick == 0 ? 8 : o.brick);
  if (o.has_background != 0) {
    given["background"] = exact(static_cast<double>(o.background));
  } else if (o.background != 0) {
    throw usage(cat("background is ", o.background, ", and has_background is 0; set it"));
  }
  return given;
}

bool all_zero(const double (&triple)[3]) { return triple[0] == 0 && triple[1] == 0 && triple[2] == 0; }
bool all_zero(const std::int64_t (&triple)[3]) { return triple[0] == 0 && triple[1] == 0 && triple[2] == 0; }
Index3 index_of(const std::int64_t (&triple)[3]) { return {triple[0], triple[1], triple[2]}; }
std::array<double, 3> array_of(const double (&triple)[3]) { return {triple[0], triple[1], triple[2]}; }

template <typename T>
std::string joined(const T* values, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += i == 0 ? "" : ",";
    if constexpr (std::is_same_v<T, double>) {
      text += exact(values[i]);
    } else {
      text += cat(values[i]);
    }
  }
  return text;
}

std::optional<StoredValue> missing_of(const char* text) {
  if (text == nullptr) return std::nullopt;
  if (*text == '\0') throw wrong_option("missing", text, "a number or nan");  // NULL means that there is none
  return read_conversion_request({{"missing", text}}).source.missing;
}

/// Runs `call` of the callback `name`. An exception of the program becomes an Error that does not read as weir's own.
template <typename Call>
void call_back(std::string_view name, const Call& call) {
  const auto let_out = [&](std::string_view text) {
    return Error(ErrorKind::internal, cat("the callback ", name, " let an exception out, which none may", text));
  };
  try {
    call();
  } catch (const std::exception& thrown) {
    throw let_out(cat(": ", thrown.what()));
  } catch (...) {
    throw let_out("");
  }
}

void give_index(const weir_input_options& o, GivenOptions& given) {
  if (o.index_count == 0) return;
  constexpr std::size_t kMaxAxes = 32;  // the most that HDF5 has
  if (o.index_count > kMaxAxes) throw usage(cat("index_count is ", o.index_count, ", it must be at most ", kMaxAxes));
  given["index"] = joined(required(o.index, "index"), o.index_count);
}

}  // namespace

DenseArray read_volume(const weir_volume* given) {
  const weir_volume volume = read_struct(given, "weir_volume");
  DenseArray array;
  array.type = scalar_type(volume.type);
  array.extent = index_of(volume.extent);
  if (const std::string obstacle = extent_obstacle(array.extent, scalar_bytes(array.type)); !obstacle.empty()) {
    throw usage(obstacle);
  }
  if (!all_zero(volume.spacing)) array.spacing = array_of(volume.spacing);
  array.origin = array_of(volume.origin);
  if (volume.name != nullptr) array.name = volume.name;
  if (array.name.size() > kMaxGridNameBytes) {
    throw usage(cat("name has ", array.name.size(), " bytes, a grid's has at most ", kMaxGridNameBytes));
  }
  if (!is_utf8(array.name)) throw usage("name is no UTF-8, which a grid's name must be");
  if (const auto missing = missing_of(volume.missing)) array.missing = {*missing};
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
  const GivenOptions method = given_method(o);
  GivenOptions given = method;
  given["threads"] = cat(o.threads);
  if (o.backend != WEIR_BACKEND_AUTO) given["backend"] = choice("backend", o.backend);
  if (o.overwrite != 0) given["overwrite"] = "true";
  if (o.work_dir != nullptr) given["work-dir"] = o.work_dir;
  ConversionOptions options = read_conversion_request(given).conversion;
  // In a library, `memory` counts besides what the process has: any size passes that the volume's own check
  // (plan_memory) accepts.
  if (o.memory > kMaxMemory) throw usage(cat("memory is ", o.memory, " bytes, it must be at most 2^50"));
  if (o.memory != 0) options.memory = o.memory;
  options.provenance = {WEIR_VERSION, build_commit(), {method.begin(), method.end()}};
  return options;
}

SourceOptions read_input_options(const weir_input_options* given) {
  if (given == nullptr) return {};
  const weir_input_options o = read_struct(given, "weir_input_options");
  GivenOptions texts;
  if (!all_zero(o.extent)) texts["dims"] = joined(o.extent, 3);
  if (o.offset != 0) texts["offset"] = cat(o.offset);
  if (o.dataset != nullptr) texts["dataset"] = o.dataset;
  give_index(o, texts);
  if (o.component != nullptr) {
    if (*o.component == '\0') throw usage("component is empty; give a position, x, y, z or magnitude, or NULL");
    texts["component"] = o.component;
  }
  if (o.magnitude != nullptr) {
    if (*o.magnitude == '\0') throw usage("magnitude is empty; give the names of two datasets or more, u,v,w, or NULL");
    texts["magnitude"] = o.magnitude;
  }
  if (o.has_level != 0) {
    texts["level"] = cat(o.level);
  } else if (o.level != 0) {
    throw usage(cat("level is ", o.level, ", and has_level is 0; set it"));
  }
  if (o.levels != WEIR_LEVELS_COMPOSITE) texts["levels"] = choice("levels", o.levels);
  if (o.upsample != WEIR_UPSAMPLE_CONSTANT) texts["upsample"] = choice("upsample", o.upsample);
  if (o.missing_chunks != WEIR_MISSING_CHUNKS_FILL)
    texts["missing-chunks"] = choice("missing-chunks", o.missing_chunks);
  if (const auto missing = missing_of(o.missing)) texts["missing"] = stored_value_text(*missing);
  if (!all_zero(o.spacing)) texts["spacing"] = joined(o.spacing, 3);
  if (o.has_origin != 0) {
    texts["origin"] = joined(o.origin, 3);
  } else if (!all_zero(o.origin)) {
    throw usage("origin is set, and has_origin is 0; set it");
  }
  if (!all_zero(o.roi_min) || !all_zero(o.roi_max)) {
    for (std::size_t i = 0; i < 3; ++i) {
      texts["roi"] += cat(i == 0 ? "" : ",", o.roi_min[i], ":", o.roi_max[i]);
    }
  }
  if (!all_zero(o.ghost)) texts["ghost"] = joined(o.ghost, 3);
  if (o.type != 0) texts["type"] = scalar_name(scalar_type(o.type));
  require_in("endian", o.endian, WEIR_ENDIAN_AUTO, WEIR_ENDIAN_BIG + 1);
  if (o.endian != WEIR_ENDIAN_AUTO) texts["endian"] = o.endian == WEIR_ENDIAN_LITTLE ? "little" : "big";
  if (o.stack != 0) texts["stack"] = "true";
  if (o.reserved != 0) throw usage(cat("reserved is ", o.reserved, ", it must be 0"));
  return read_conversion_request(texts).source;
}

std::string checked_output(const char* path) {
  std::string output = required_path(path, "output");
  std::error_code ignored;
  if (std::filesystem::is_directory(output, ignored)) {
    throw usage(cat(output, ": is a directory; name a file in it"));
  }
  return output;
}

void keep_places(ConversionOptions& options) {
  for (std::string* path : {&options.output, &options.work_dir}) {
    if (path->empty()) continue;
    std::error_code obstacle;
    const std::filesystem::path absolute = std::filesystem::absolute(*path, obstacle);
    if (obstacle) {
      throw Error(ErrorKind::io, cat(*path, ": the working directory cannot be told: ", obstacle.message(),
                                     "; give an absolute path"));
    }
    *path = absolute.string();
  }
}

ConversionControl Callbacks::control() {
  ConversionControl control;
  control.cancel = &cancelled_;
  control.pass_started = [this](const std::string& pass, std::uint64_t total) { start(pass, total); };
  control.pass_advanced = [this](std::uint64_t done) { advance(done); };
  if (options_.notice != nullptr) {
    control.notice = [this](const Message& line) {
      const std::scoped_lock lock(mutex_);
      const std::string text = one_line(line.worded(c_wording));
      call_back("notice", [&] { options_.notice(options_.user, text.c_str()); });
    };
  }
  return control;
}

void Callbacks::start(const std::string& pass, std::uint64_t total_bytes) {
  const std::scoped_lock lock(mutex_);
  pass_ = pass;
  total_bytes_ = total_bytes;
  tell_progress(0);
  ask_cancel();
}

void Callbacks::advance(std::uint64_t done_bytes) {
  const std::scoped_lock lock(mutex_);
  // A push has no survey pass of its own, but may still read its spooled data to find the background.
  if (!pass_.empty()) tell_progress(std::min(done_bytes, total_bytes_));
  ask_cancel();
}

void Callbacks::look_for_cancel() {
  const std::scoped_lock lock(mutex_);
  ask_cancel();
}

void Callbacks::tell_progress(std::uint64_t done_bytes) {
  if (options_.progress == nullptr) return;
  call_back("progress", [&] { options_.progress(options_.user, pass_.c_str(), done_bytes, total_bytes_); });
}

void Callbacks::ask_cancel() {
  if (options_.cancel == nullptr) return;
  call_back("cancel", [&] {
    if (options_.cancel(options_.user) != 0) cancelled_ = true;
  });
}

}  // namespace weir::c
