#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include "bindings/c/conversion_options.h"
#include "bindings/c/status.h"
#include "bindings/c/versioned_struct.h"
#include "bindings/c/weir.h"
#include "compressor/conversion_memory.h"
#include "compressor/levels/level_budgets.h"
#include "compressor/options/conversion_request.h"
#include "compressor/plan/memory_plan.h"
#include "format/base/text.h"
#include "format/io/memory_file_system.h"
#include "format/io/output_names.h"
#include "format/process/process_memory.h"
#include "gpu/packed/coder_choice.h"
#include "ingest/series_names.h"
#include "ingest/source_registry.h"

struct weir_buffer {
  weir::MemoryFileSystem files;
  std::span<const std::byte> volume;
  std::string sidecar;
};

namespace weir::c {
namespace {

/// Opens an array of these values.
std::unique_ptr<VolumeSource> open_values(const weir_volume* volume, const void* data, const std::int64_t* stride,
                                          const weir_convert_options& given) {
  DenseArray array = read_volume(volume);
  array.keeps_missing = given.missing_policy == WEIR_MISSING_POLICY_KEEP;
  array.data = required(data, "data");
  array.stride = stride == nullptr ? packed_stride(array.extent, array.type)
                                   : std::array<std::int64_t, 3>{stride[0], stride[1], stride[2]};
  return open_array(array);
}

void convert(VolumeSource& source, ConversionOptions options, ConversionControl control, FileSystem& files) {
  // Memory that the process has already taken is the caller's. plan_memory() reports too little memory in the caller's
  // figures.
  const Box domain = source.info().domain();
  const std::size_t threads = choose_threads(options.threads, processors_or_all(options.processors), options.memory,
                                             source.working_bytes(), domain, region_bytes(options));
  plan_memory(options.memory, source.working_bytes(), threads, domain, region_bytes(options));
  const std::unique_ptr<BlockCoder> coder =
      choose_coder(options.backend, options.encoding == Encoding::packed, options.memory, control.notice);
  control.coder = coder.get();
  options.memory += resident_bytes();
  options.resume = Resume::off;
  convert_volume(source, options, control, files);
}

}  // namespace
}  // namespace weir::c

using namespace weir;
using namespace weir::c;

weir_status weir_volume_init(weir_volume* volume, size_t struct_size) { return init_struct(volume, struct_size); }
weir_status weir_convert_options_init(weir_convert_options* options, size_t struct_size) {
  return init_struct(options, struct_size);
}
weir_status weir_input_options_init(weir_input_options* options, size_t struct_size) {
  return init_struct(options, struct_size);
}

weir_status weir_convert(const weir_volume* volume, const void* data, const int64_t stride[3],
                         const weir_convert_options* options, const char* output, weir_error* error) {
  return guarded(error, [&] {
    const weir_convert_options given = options_or_defaults(options);
    const auto source = open_values(volume, data, stride, given);
    ConversionOptions conversion = read_options(given);
    conversion.output = checked_output(output);
    Callbacks callbacks(given);
    convert(*source, std::move(conversion), callbacks.control(), *make_posix_file_system());
  });
}

weir_status weir_convert_to_memory(const weir_volume* volume, const void* data, const int64_t stride[3],
                                   const weir_convert_options* options, weir_buffer** buffer, weir_error* error) {
  return guarded(error, [&] {
    required(buffer, "buffer");
    const weir_convert_options given = options_or_defaults(options);
    const auto source = open_values(volume, data, stride, given);
    ConversionOptions conversion = read_options(given);
    if (!conversion.work_dir.empty()) {
      throw usage(cat("work_dir is \"", conversion.work_dir, "\", and nothing goes to a disk; leave it NULL"));
    }
    conversion.output = "memory.nvdb";
    auto made = std::make_unique<weir_buffer>();
    Callbacks callbacks(given);
    convert(*source, conversion, callbacks.control(), made->files);
    made->volume = made->files.content(conversion.output);
    const auto sidecar = made->files.content(sidecar_path(conversion.output));
    made->sidecar.assign(reinterpret_cast<const char*>(sidecar.data()), sidecar.size());
    *buffer = made.release();
  });
}

const void* weir_buffer_data(const weir_buffer* buffer) { return buffer == nullptr ? nullptr : buffer->volume.data(); }
uint64_t weir_buffer_size(const weir_buffer* buffer) { return buffer == nullptr ? 0 : buffer->volume.size(); }
const char* weir_buffer_sidecar(const weir_buffer* buffer) {
  return buffer == nullptr ? nullptr : buffer->sidecar.c_str();
}
void weir_buffer_free(weir_buffer* buffer) { delete buffer; }

weir_status weir_convert_file(const char* input, const weir_input_options* input_options,
                              const weir_convert_options* options, const char* output, weir_error* error) {
  return guarded(error, [&] {
    const std::string path = required_path(input, "input");
    SourceOptions source_options = read_input_options(input_options);
    const weir_convert_options given = options_or_defaults(options);
    ConversionOptions conversion = read_options(given);
    source_options.keeps_missing = conversion.missing == MissingPolicy::keep;
    settle_gaps(source_options, conversion);
    conversion.output = checked_output(output);
    std::error_code ignored;
    if (std::filesystem::equivalent(path, conversion.output, ignored)) {
      throw usage(cat(conversion.output, ": is the input; choose another output"));
    }
    Callbacks callbacks(given);
    const ConversionControl control = callbacks.control();
    source_options.cancel = control.cancel;
    source_options.notice = control.notice;
    source_options.memory = conversion.memory + resident_bytes();
    source_options.spool_directory =
        conversion.work_dir.empty() ? directory_of(conversion.output) : conversion.work_dir;
    if (source_options.levels == Levels::composite) {
      convert(*open_source(path, source_options), std::move(conversion), control, *make_posix_file_system());
      return;
    }
    const std::vector<SeriesStep> levels = expand_series(std::vector{path}, source_options);
    const std::vector<std::string> outputs = series_outputs(levels, conversion.output, source_options);
    const auto open = [&](const SeriesStep& level) {
      return open_source(path, options_of_step(source_options, level));
    };
    for (std::size_t i = 0; i < levels.size(); ++i) {
      check_level_budgets(levels, outputs, i, conversion, open);
      conversion.output = outputs[i];
      convert(*open(levels[i]), conversion, control, *make_posix_file_system());
    }
  });
}
