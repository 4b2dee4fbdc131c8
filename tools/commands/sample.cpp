// weir sample: writes a synthetic volume as a raw file.
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <future>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/io/file_system.h"
#include "format/output/partial_file.h"
#include "format/process/process_memory.h"
#include "ingest/raw/raw_name.h"
#include "ingest/source/extent.h"
#include "ingest/synthetic/pack_values.h"
#include "ingest/synthetic/slabs.h"
#include "ingest/synthetic/synthetic.h"
#include "tools/command.h"
#include "tools/options/run_options.h"
#include "tools/options/table_options.h"

namespace weir {
namespace {

/// Memory besides the slabs: program, libraries, stacks and lattices.
constexpr std::uint64_t kFixedBytes = std::uint64_t{40} << 20U;
/// Larger slabs are not faster and keep the writer waiting at the end.
constexpr std::uint64_t kMostSlabBytes = std::uint64_t{96} << 20U;

struct SampleArguments {
  std::string kind;
  std::string output;
  std::uint64_t seed = 1;
  bool overwrite = false;
  bool json = false;
  GivenOptions options;
  ProgressOptions progress;
};

/// The layout of the file, after options and name were reconciled.
struct Shape {
  Index3 extent;
  ScalarType type = ScalarType::float32;
  bool big_endian = false;
};

Error contradiction(const std::string& path, const Message& given, const std::string& named) {
  return {ErrorKind::usage, compose(path, ": ", given, " contradicts the file's name, which says ", named,
                                    "; drop the option or choose another name")};
}

// Returns the layout. A name of the pattern NAME_XxYxZ_TYPE.raw must be true, because readers believe it.
Shape resolve_shape(const SampleArguments& arguments, const SourceOptions& options) {
  const std::string& path = arguments.output;
  if (path == "-") {
    throw usage_error(
        "-: cannot write to standard output: slabs are written in place; name a file, and stream that when it is done");
  }
  const auto given = [&](const char* key) { return option(key, arguments.options.at(key)); };
  const auto name = parse_raw_name(path);
  if (!name && !options.extent) {
    throw Error(ErrorKind::usage, cat(path, ": extent unknown; give --dims X,Y,Z or name it NAME_XxYxZ_TYPE.raw"));
  }
  if (name && options.extent && *options.extent != name->extent) {
    throw contradiction(path, given("dims"), extent_text(name->extent));
  }
  Shape shape{options.extent ? *options.extent : name->extent, options.type.value_or(ScalarType::float32),
              options.big_endian.value_or(false)};
  if (!name) return shape;
  if (!options.extent && !is_synthetic_extent(name->extent)) {
    throw usage_error(
        cat(path, ": the name says ", extent_text(name->extent), "; ", kSyntheticExtents, "; choose another name"));
  }
  if (!name->type) {
    throw Error(ErrorKind::usage,
                cat(path, ": unknown type '", name->type_text, "' in the file's name; it must be one of ",
                    scalar_names(), ", with be appended for big-endian"));
  }
  if (options.type && *options.type != *name->type) throw contradiction(path, given("type"), name->type_text);
  if (options.big_endian && *options.big_endian != name->big_endian) {
    throw contradiction(path, given("endian"), name->type_text);
  }
  return {shape.extent, *name->type, name->big_endian};
}

/// Returns the voxels of a slab. Two slabs of floats are held, and two of packed bytes unless the floats themselves
/// are written.
std::int64_t slab_voxels(std::uint64_t memory, const ValuePacker& packer, ScalarType type) {
  const std::uint64_t voxel_bytes = 4 + (packer.is_identity() ? 0 : scalar_bytes(type));
  const std::uint64_t slab_bytes = std::min((memory - kFixedBytes) / 2, kMostSlabBytes);
  return static_cast<std::int64_t>(slab_bytes / voxel_bytes);
}

/// Makes slab after slab; a slab is written while the next slab is made.
class SlabWriter {
 public:
  SlabWriter(VolumeSource& source, const ValuePacker& packer, ScalarType type, File& file)
      : source_(source), packer_(packer), value_bytes_(scalar_bytes(type)), file_(file) {}
  ~SlabWriter() {
    if (writing_.valid()) writing_.wait();
  }
  SlabWriter(const SlabWriter&) = delete;
  SlabWriter& operator=(const SlabWriter&) = delete;

  void write(const Box& slab) {
    const auto voxels = static_cast<std::size_t>(slab.voxels());
    Buffers& buffers = buffers_.at(next_);
    next_ = 1 - next_;
    buffers.values.resize(voxels);
    source_.read(slab, buffers.values);
    std::span<const std::byte> bytes = std::as_bytes(std::span(buffers.values));
    if (!packer_.is_identity()) {
      buffers.bytes.resize(voxels * value_bytes_);
      packer_.pack(buffers.values, buffers.bytes);
      bytes = buffers.bytes;
    }
    const auto offset = static_cast<std::uint64_t>(linear_index(slab.lo, source_.info().extent)) * value_bytes_;
    finish();
    writing_ = std::async(std::launch::async, [this, offset, bytes] { file_.write_at(offset, bytes); });
  }
  /// Waits for the last write and rethrows its exception.
  void finish() {
    if (writing_.valid()) writing_.get();
  }

 private:
  struct Buffers {
    std::vector<float> values;
    std::vector<std::byte> bytes;
  };

  VolumeSource& source_;
  const ValuePacker& packer_;
  std::size_t value_bytes_;
  File& file_;
  std::array<Buffers, 2> buffers_;
  std::size_t next_ = 0;
  std::future<void> writing_;
};

void sample(const SampleArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const auto [given, run] = read_conversion_request(arguments.options);
  const SyntheticKind& kind = find_synthetic_kind(arguments.kind);
  const Shape shape = resolve_shape(arguments, given);
  const ValuePacker packer(kind, shape.type, shape.big_endian);
  const auto source = open_synthetic(kind.name, {shape.extent, arguments.seed});
  const std::int64_t voxels = volume(shape.extent);
  const std::uint64_t value_bytes = scalar_bytes(shape.type);
  const std::uint64_t bytes = static_cast<std::uint64_t>(voxels) * value_bytes;
  const auto threads = limit_threads(run.threads);

  const auto files = make_posix_file_system();
  PartialFile output(*files, arguments.output, arguments.overwrite);
  output.reserve(bytes);

  Progress progress(arguments.progress);
  progress.start(cat("sample ", kind.name), bytes);
  {
    SlabWriter writer(*source, packer, shape.type, output.file());
    const std::int64_t most = slab_voxels(run.memory, packer, shape.type);
    for (std::int64_t first = 0; first < voxels;) {
      if (interrupt_flag()) {
        throw Error(ErrorKind::interrupted, cat(arguments.output, ": interrupted; nothing was left behind"));
      }
      const Box slab = slab_at(shape.extent, first, most);
      writer.write(slab);
      first += slab.voxels();
      progress.update(static_cast<std::uint64_t>(first) * value_bytes);
    }
    writer.finish();
  }
  output.commit();
  progress.finish();

  const double total_s = seconds_since(start);
  if (arguments.json) {
    const nlohmann::json report{{"output", arguments.output},
                                {"kind", kind.name},
                                {"extent", {shape.extent.x, shape.extent.y, shape.extent.z}},
                                {"type", scalar_name(shape.type)},
                                {"endian", shape.big_endian ? "big" : "little"},
                                {"seed", arguments.seed},
                                {"bytes", bytes},
                                {"total_s", total_s},
                                {"peak_rss_bytes", peak_resident_bytes()}};
    std::cout << json_text(report, 2) << '\n';
  } else {
    spdlog::info("{}: {} {} {}, {}, {:.2f} s", arguments.output, kind.name, extent_text(shape.extent),
                 scalar_name(shape.type), format_bytes(bytes), total_s);
  }
}

std::string kind_list() {
  std::string text = "Kinds:";
  for (const SyntheticKind& kind : synthetic_kinds()) {
    text += cat("\n  ", kind.name, std::string(16 - kind.name.size(), ' '), kind.description);
  }
  return text;
}

// Checks the seed here, because the parser accepts a number that is out of range.
std::string is_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error == std::errc{} && rest == text.data() + text.size()) return {};
  throw wrong_option("seed", text, cat("a whole number from 0 to ", ~std::uint64_t{0}));
}

}  // namespace

void add_sample(CLI::App& app) {
  auto arguments = std::make_shared<SampleArguments>();
  CLI::App* command = app.add_subcommand("sample", "Writes a synthetic volume as a raw file");
  command->footer(kind_list);
  command->add_option("kind", arguments->kind, "which volume, see below")->required()->type_name("KIND");
  command->add_option("-o,--output", arguments->output, "raw file; NAME_XxYxZ_TYPE.raw says what is in it")
      ->required()
      ->type_name("FILE.raw");
  OptionRow dims = conversion_option("dims");
  dims.help = "voxels";
  dims.standard = "the name's";
  OptionRow type = conversion_option("type");
  type.help = "uint8, int8, uint16, int16, uint32, int32, float32 or float64";
  type.standard = "the name's, else float32; integers are scaled to their range";
  for (const OptionRow& row : {dims, type, conversion_option("endian")}) {
    add_option(*command, row, arguments->options);
  }
  command->add_option("--seed", arguments->seed, "of the kinds with randomness")
      ->type_name("N")
      ->capture_default_str()
      ->check(is_seed);
  command->add_flag("--overwrite", arguments->overwrite, "replace an existing file");
  add_run_options(*command, arguments->options, arguments->progress);
  command->add_flag("--json", arguments->json, "report as one JSON object on stdout");
  add_log_level(*command);
  command->callback([arguments] { sample(*arguments); });
}

}  // namespace weir
