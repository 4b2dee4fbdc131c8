#include "bindings/python/convert.h"

#include <array>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>

#include "bindings/python/watch.h"
#include "compressor/build_commit.h"
#include "compressor/conversion.h"
#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/process_memory.h"
#include "format/base/text.h"
#include "format/output/output_files.h"
#include "ingest/series.h"
#include "ingest/source/source_view.h"
#include "ingest/source_registry.h"
#include "ingest/values/array_source.h"
#include "tools/options/given_options.h"
#include "tools/options/table_options.h"
#include "tools/report/finished_output.h"

namespace weir::python {

namespace py = pybind11;

namespace {

/// What a call asks for. No interpreter is needed from here on.
ConversionRequest make_request(const std::string& output, const GivenOptions& given) {
  ConversionRequest request = read_conversion_request(given);
  request.conversion.output = output;
  // The program's own data are in the process as well, and none of the conversion's business.
  request.conversion.memory += resident_bytes();
  request.source.memory = request.conversion.memory;
  request.conversion.provenance = {WEIR_VERSION, build_commit(), recorded_options(given)};
  return request;
}

using OpenSource = std::function<std::unique_ptr<VolumeSource>()>;

std::string convert(const ConversionOptions& options, const OpenSource& open, const py::object& progress) {
  std::string sidecar;
  run_watched(progress, [&](Watch& watch) {
    ConversionControl control;
    control.cancel = &watch.cancelled();
    control.pass_started = [&](const std::string& pass, std::uint64_t bytes) { watch.start(pass, bytes); };
    control.pass_advanced = [&](std::uint64_t done) { watch.advance(done); };
    control.notice = [&](const Message& line) { watch.notice(line); };
    const std::unique_ptr<FileSystem> files = make_posix_file_system();
    const std::unique_ptr<VolumeSource> source = open();
    sidecar = to_json_text(convert_volume(*source, options, control, *files));
  });
  return sidecar;
}

DenseArray dense_array(const py::array& array, const std::string& type, const SourceOptions& options) {
  if (array.ndim() != 3) throw Error(ErrorKind::internal, cat("an array of ", array.ndim(), " axes"));
  DenseArray dense;
  dense.data = array.data();
  dense.type = parse_scalar(type).value();
  dense.extent = {array.shape(2), array.shape(1), array.shape(0)};
  dense.stride = {array.strides(2), array.strides(1), array.strides(0)};
  if (options.spacing) dense.spacing = *options.spacing;
  if (options.origin) dense.origin = *options.origin;
  dense.name = options.dataset;
  if (options.missing) dense.missing.push_back(*options.missing);
  return dense;
}

}  // namespace

std::string convert_file(const std::string& source, const std::string& output, const GivenOptions& options,
                         const py::object& progress) {
  ConversionRequest request = make_request(output, options);
  SeriesStep step;
  {
    const py::gil_scoped_release unlocked;
    const std::vector<SeriesStep> steps = expand_series(std::vector{source}, request.source);
    if (steps.size() != 1)
      throw usage_error(cat(source, ": names ", steps.size(), " volumes; convert them one by one"));
    step = steps.front();
    request.conversion.output = series_outputs(steps, output).front();
    check_output(step.path, request.conversion.output);
  }
  request.source.dataset = step.dataset;
  request.source.index = step.index;
  request.source.spool_directory =
      request.conversion.work_dir.empty() ? directory_of(request.conversion.output) : request.conversion.work_dir;
  return convert(
      request.conversion, [&] { return open_source(step.path, request.source); }, progress);
}

std::string convert_array(const py::array& source, const std::string& type, const std::string& output,
                          const GivenOptions& options, const py::object& progress) {
  ConversionRequest request = make_request(output, options);
  constexpr std::array<std::string_view, 5> kOfArrays{"dataset", "missing", "spacing", "origin", "roi"};
  if (const std::string key = given_input_option(options, kOfArrays); !key.empty()) {
    throw usage_error(compose(option(key), " says how to read a file; source is an array"));
  }
  check_output({}, output);
  request.conversion.resume = Resume::off;
  const DenseArray array = dense_array(source, type, request.source);
  return convert(
      request.conversion,
      [&] {
        std::unique_ptr<VolumeSource> all = open_array(array);
        return request.source.roi ? crop_source(std::move(all), *request.source.roi) : std::move(all);
      },
      progress);
}

}  // namespace weir::python
