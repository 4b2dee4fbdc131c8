#include "bindings/python/convert.h"

#include <pybind11/stl.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "bindings/python/device_source.h"
#include "bindings/python/interpreter_end.h"
#include "bindings/python/watch.h"
#include "compressor/build_commit.h"
#include "compressor/conversion.h"
#include "compressor/levels/level_budgets.h"
#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"
#include "format/nanovdb/grid_head.h"
#include "format/process/process_memory.h"
#include "gpu/packed/coder_choice.h"
#include "ingest/series_names.h"
#include "ingest/source/source_view.h"
#include "ingest/source_registry.h"
#include "ingest/values/array_source.h"
#include "tools/options/given_options.h"
#include "tools/options/result_directory.h"
#include "tools/options/series_checks.h"
#include "tools/options/table_options.h"
#include "tools/report/finished_output.h"

namespace weir::python {

namespace py = pybind11;

namespace {

/// Returns the request of a call. No interpreter is needed from here on.
ConversionRequest make_request(const std::string& output, const GivenOptions& given) {
  ConversionRequest request = read_conversion_request(given);
  request.conversion.output = output;
  request.source.memory = request.conversion.memory + resident_bytes();
  request.conversion.provenance = {WEIR_VERSION, build_commit(), recorded_options(given)};
  return request;
}

/// Opens a source, given the control that watches the conversion and has the coder of its blocks.
using OpenSource = std::function<std::unique_ptr<VolumeSource>(const ConversionControl&)>;

Sidecar convert(ConversionOptions options, const OpenSource& open, const py::object& progress) {
  std::optional<Sidecar> sidecar;
  run_watched(progress, [&](Watch& watch) {
    ConversionControl control;
    control.cancel = &watch.cancelled();
    control.pass_started = [&](const std::string& pass, std::uint64_t bytes) { watch.start(pass, bytes); };
    control.pass_advanced = [&](std::uint64_t done) { watch.advance(done); };
    control.notice = [&](const Message& line) { watch.notice(line); };
    control.before_commit = [&] { watch.settle(); };
    const std::unique_ptr<BlockCoder> coder =
        choose_coder(options.backend, options.encoding == Encoding::packed, options.memory, control.notice);
    control.coder = coder.get();
    // The program's own data are in the process too, and do not count as the conversion's memory.
    options.memory += resident_bytes();
    const std::unique_ptr<FileSystem> files = make_posix_file_system();
    const std::unique_ptr<VolumeSource> source = open(control);
    sidecar = convert_volume(*source, options, control, *files);
  });
  return *std::move(sidecar);
}

// `shape` and `strides` are of the axes z, y, x.
DenseArray dense_array(const void* data, const std::array<std::int64_t, 3>& shape,
                       const std::array<std::int64_t, 3>& strides, const std::string& type,
                       const SourceOptions& options) {
  DenseArray dense;
  dense.data = data;
  dense.type = parse_scalar(type).value();
  dense.extent = {shape[2], shape[1], shape[0]};
  dense.stride = {strides[2], strides[1], strides[0]};
  if (options.spacing) dense.spacing = *options.spacing;
  if (options.origin) dense.origin = *options.origin;
  dense.name = options.dataset;
  if (dense.name.size() > kMaxGridNameBytes) {
    throw usage_error(compose(option("dataset"), " has ", dense.name.size(), " bytes, a grid's name has at most ",
                              kMaxGridNameBytes));
  }
  if (options.missing) dense.missing.push_back(*options.missing);
  dense.keeps_missing = options.keeps_missing;
  return dense;
}

std::string text_at(const py::dict& dict, const char* key) {
  return dict.contains(key) ? dict[key].cast<std::string>() : "";
}

// Adds the description of values and axes in `meaning`, for the sidecar.
void add_meaning(const py::dict& meaning, DenseArray& array) {
  array.units = text_at(meaning, "units");
  array.details.long_name = text_at(meaning, "long_name");
  if (meaning.contains("time")) {
    const auto [value, units] = meaning["time"].cast<std::pair<double, std::string>>();
    array.details.time = TimePoint{value, units, text_at(meaning, "calendar")};
  }
  if (!meaning.contains("axes")) return;
  std::size_t i = 0;
  for (const py::handle handle : meaning["axes"]) {
    const auto axis = handle.cast<py::dict>();
    AxisDetails& details = array.details.axes.at(i);
    array.axis_labels.at(i) = text_at(axis, "name");
    details.units = text_at(axis, "units");
    details.note = text_at(axis, "note");
    if (axis.contains("reversed")) details.reversed = axis["reversed"].cast<bool>();
    if (axis.contains("coordinates")) details.coordinates = axis["coordinates"].cast<std::vector<double>>();
    ++i;
  }
}

}  // namespace

std::vector<std::string> convert_files(const std::string& source, const std::string& output,
                                       const GivenOptions& options, bool several, const py::object& progress) {
  ConversionRequest request = make_request(output, options);
  const Budget budget = request.conversion.budget;
  std::vector<SeriesStep> steps;
  std::vector<std::string> outputs;
  const std::unique_ptr<FileSystem> files = make_posix_file_system();
  std::optional<ResultDirectory> directory;
  SeriesExtents extents(budget);
  const auto open_step = [&](const SeriesStep& step) {
    return open_source(step.path, options_of_step(request.source, step));
  };
  run_watched(py::none(), [&](Watch& watch) {
    request.source.cancel = &watch.cancelled();
    steps = expand_series(std::vector{source}, request.source, [&](const Message& line) { watch.notice(line); });
    if (!several && steps.size() != 1) {
      throw usage_error(compose(source, ": names ", cat(steps.size()), " volumes; give ", option("dataset"),
                                " as a list for all of them, or convert them one by one"));
    }
    outputs = series_outputs(steps, output, request.source);
    check_outputs(steps, outputs, request.conversion.overwrite);
    extents.check_all(steps, open_step);
    if (output.ends_with('/')) directory.emplace(*files, directory_of(output));
  });
  std::vector<Sidecar> sidecars;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    request.conversion.output = outputs[i];
    request.source.spool_directory =
        request.conversion.work_dir.empty() ? directory_of(outputs[i]) : request.conversion.work_dir;
    const auto open = [&](const ConversionControl& control) {
      request.source.notice = control.notice;
      request.source.cancel = control.cancel;
      check_level_budgets(steps, outputs, i, request.conversion, open_step);
      std::unique_ptr<VolumeSource> opened = open_step(steps[i]);
      extents.check(steps[i], opened->info());
      return opened;
    };
    sidecars.push_back(convert(request.conversion, open, progress));
  }
  std::vector<std::string> texts;
  for (const Sidecar& sidecar : sidecars) texts.push_back(to_json_text(sidecar));
  return texts;
}

namespace {

using Axes = std::array<std::int64_t, 3>;
using OpenArray =
    std::function<std::unique_ptr<VolumeSource>(const DenseArray&, const ConversionRequest&, const ConversionControl&)>;

std::string convert_dense(const void* data, const Axes& shape, const Axes& strides, const std::string& type,
                          const std::string& output, const GivenOptions& options, const py::dict& meaning,
                          const py::object& progress, const OpenArray& open) {
  ConversionRequest request = make_request(output, options);
  constexpr std::array<std::string_view, 7> kOfArrays{"dataset", "missing", "missing-policy", "spacing",
                                                      "origin",  "roi",     "ghost"};
  if (const std::string key = given_input_option(options, kOfArrays); !key.empty()) {
    throw usage_error(compose(option(key), " says how to read a file; source is an array"));
  }
  check_output({}, output);
  request.conversion.resume = Resume::off;
  DenseArray array = dense_array(data, shape, strides, type, request.source);
  add_meaning(meaning, array);
  return to_json_text(convert(
      request.conversion,
      [&](const ConversionControl& control) {
        std::unique_ptr<VolumeSource> all = open(array, request, control);
        if (!request.source.roi) return all;
        return crop_to(std::move(all), *request.source.roi);
      },
      progress));
}

}  // namespace

std::string convert_array(const py::array& source, const std::string& type, const std::string& output,
                          const GivenOptions& options, const py::dict& meaning, const py::object& progress) {
  if (source.ndim() != 3) throw Error(ErrorKind::internal, cat("an array of ", source.ndim(), " axes"));
  return convert_dense(
      source.data(), {source.shape(0), source.shape(1), source.shape(2)},
      {source.strides(0), source.strides(1), source.strides(2)}, type, output, options, meaning, progress,
      [](const DenseArray& array, const ConversionRequest&, const ConversionControl&) { return open_array(array); });
}

std::string convert_device_array(std::uint64_t address, const std::array<std::int64_t, 3>& shape,
                                 const std::array<std::int64_t, 3>& strides, const std::string& type,
                                 const std::optional<std::uint64_t>& stream, const std::string& output,
                                 const GivenOptions& options, const py::dict& meaning, const py::object& progress) {
  const auto* const data = reinterpret_cast<const void*>(address);
  if (stream) without_lock([&] { wait_for_stream(data, *stream); });
  return convert_dense(data, shape, strides, type, output, options, meaning, progress, open_device_source);
}

}  // namespace weir::python
