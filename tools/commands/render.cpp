// weir render: draws a picture of a NanoVDB file, or of the source it would be made from.
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdint>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/io/file_id.h"
#include "format/io/file_system.h"
#include "format/nanovdb/nvdb_file.h"
#include "gpu/image/image_output.h"
#include "gpu/render/volume_error.h"
#include "ingest/source/convert_command.h"
#include "ingest/source/source_files.h"
#include "ingest/source_registry.h"
#include "tools/command.h"
#include "tools/command_request.h"
#include "tools/export/dense_input.h"
#include "tools/options/backend_choice.h"
#include "tools/options/finite_range.h"
#include "tools/options/picture_options.h"
#include "tools/options/run_options.h"
#include "tools/options/table_options.h"
#include "tools/plot/color_bar.h"
#include "tools/report/foreign_file.h"
#include "tools/report/map_warning.h"
#include "tools/report/opacity_warning.h"
#include "tools/report/progress.h"
#include "tools/report/quantity_title.h"
#include "tools/report/surface_warning.h"

namespace weir {

namespace {

struct RenderArguments {
  std::string input;
  std::string output;
  std::string volume = "file";
  GivenOptions source;
  GivenOptions picture;
  ProgressOptions progress;
  bool overwrite = false;
  bool json = false;
};

struct LoadedInput {
  std::unique_ptr<LoadedVolume> volume;
  std::string title;            ///< what the values are
  std::optional<MinMax> range;  ///< range of the finite values, if known
};

LoadedInput load_file(Backend& backend, const RenderArguments& arguments) {
  if (const std::string key = given_input_option(arguments.source); !key.empty()) {
    throw Error(ErrorKind::usage,
                compose(option(key), " says how to read a source; give ", option("volume", "dense"), " with it"));
  }
  if (is_foreign_file(arguments.input)) {
    throw input_error(arguments.input,
                      compose("is no NanoVDB file; convert it first: weir convert ", shell_word(arguments.input),
                              ", or draw its own values with ", option("volume", "dense")));
  }
  const auto file = std::make_shared<const NvdbFile>(arguments.input);
  if (const std::string warning = map_warning(file->grid()); !warning.empty()) {
    spdlog::warn("{}: {}", arguments.input, warning);
  }
  return {naming_volume(arguments.input, [&] { return backend.load(file, 0, nullptr); }), quantity_title(*file),
          known_range(*file)};
}

LoadedInput load_dense(Backend& backend, const RenderArguments& arguments, std::optional<std::uint64_t> ceiling,
                       Progress& progress) {
  const ConversionRequest request = command_request(arguments.source);
  const auto source = open_source(arguments.input, request.source);
  require_not_input(source_file_ids(source->info()), arguments.output);
  progress.start("read", static_cast<std::uint64_t>(source->info().domain().voxels()) * sizeof(float));
  StreamOptions options;
  options.cancel = &interrupt_flag();
  options.progress = [&](std::int64_t done, std::int64_t) {
    progress.update(static_cast<std::uint64_t>(done) * sizeof(float));
  };
  std::unique_ptr<LoadedVolume> volume =
      backend.load_dense(read_dense(*source, options, request.conversion.missing, ceiling), 0);
  const MinMax range = volume->info().range;
  return {std::move(volume), quantity_title(source->info()), range};
}

// Returns the counts; null if nothing was looked up in a cache.
nlohmann::json to_json(const CacheCounts& counts) {
  if (counts.lookups == 0) return nullptr;
  return {{"lookups", counts.lookups}, {"decoded", counts.decoded}, {"evicted", counts.evicted}};
}

// Gives a scene without a range the range of the values, if known. Warns of values that the scene cannot show.
void fit_scene(Scene& scene, const std::optional<MinMax>& range, const GivenOptions& given) {
  if (range) {
    if (const std::string line = surface_warning(scene, *range); !line.empty()) spdlog::warn("{}", line);
    if (!scene.volume.range) scene.volume.range = {range->min, range->max};
  }
  if (const std::string line = opacity_warning(scene); !line.empty()) spdlog::warn("{}: {}", given.at("scene"), line);
}

// The figures of a report besides the picture's own.
struct RenderFigures {
  std::string_view backend;
  const LoadSummary& loaded;
  double load_s;
  std::uint64_t bytes;     // bytes of the image file
  std::int32_t bar_width;  // of the colour bar in pixels; 0: none
};

// Prints the report on stdout with --json, otherwise logs most of it.
void write_report(const RenderArguments& arguments, const PictureRequest& request, const Picture& picture,
                  const RenderFigures& figures) {
  if (!arguments.json) {
    if (!picture.levels_note.empty()) spdlog::info("{}: {}", arguments.input, picture.levels_note);
    spdlog::info("{}: {} x {}, {} samples a pixel, {:.2f} s", arguments.output, picture.image.width,
                 picture.image.height, request.sampling.samples, picture.render_s);
    return;
  }
  const nlohmann::json report{{"image", arguments.output},
                              {"bytes", figures.bytes},
                              {"width", picture.image.width},
                              {"height", picture.image.height},
                              {"colorbar_width", figures.bar_width},
                              {"mode", render_mode_name(request.scene.mode)},
                              {"filter", filter_name(request.options.filter)},
                              {"volume", arguments.volume},
                              {"backend", figures.backend},
                              {"samples", request.sampling.samples},
                              {"seed", request.options.seed},
                              {"load",
                               {{"way", figures.loaded.way},
                                {"bytes", figures.loaded.bytes},
                                {"memory_bytes", figures.loaded.memory},
                                {"transfer_s", figures.loaded.seconds},
                                {"note", figures.loaded.note}}},
                              {"cache", to_json(picture.cache)},
                              {"finest_level", picture.finest_level},
                              {"levels_note", picture.levels_note},
                              {"memory_note", picture.memory_note},
                              {"load_s", figures.load_s},
                              {"render_s", picture.render_s}};
  std::cout << json_text(report, 2) << '\n';
}

void render(const RenderArguments& arguments) {
  PictureRequest request = read_picture_request(arguments.picture);
  request.sampling.cancel = &interrupt_flag();
  const auto threads = limit_threads(static_cast<std::size_t>(request.backend.threads));
  const std::unique_ptr<FileSystem> files = make_posix_file_system();
  std::vector<std::string> inputs = picture_inputs(arguments.picture, request);
  inputs.push_back(arguments.input);
  require_not_input(file_ids(inputs), arguments.output);
  ImageFile image_file(*files, arguments.output, arguments.overwrite);
  if (request.colorbar && image_file.linear()) {
    throw Error(ErrorKind::usage, compose(arguments.output, ": holds radiance, and ", option("colorbar"),
                                          " colours as a screen shows them; choose a name that ends in .png"));
  }
  const std::unique_ptr<Backend> backend = make_backend(request.backend, warn);
  Progress progress(arguments.progress);
  const auto start = std::chrono::steady_clock::now();
  const auto [volume, title, range] = arguments.volume == "dense"
                                          ? load_dense(*backend, arguments, request.backend.memory.ceiling, progress)
                                          : load_file(*backend, arguments);
  const double load_s = seconds_since(start);
  const LoadSummary& loaded = volume->load_summary();
  if (!arguments.json && loaded.way == "cached") spdlog::info("{}: {}", arguments.input, loaded.note);
  fit_scene(request.scene, range, arguments.picture);
  std::optional<Image> bar;
  if (request.colorbar) {
    bar =
        draw_color_bar(picture_transfer(volume->info(), request.scene, request.options), title, request.options.height);
  }
  progress.start(cat("render, ", render_mode_name(request.scene.mode)), request.pixel_samples(), ProgressUnit::samples);
  request.sampling.progress = [&](std::uint64_t done) { progress.update(done); };
  Picture picture = naming_volume(arguments.input, [&, &drawn = *volume] {
    return backend->render(drawn, request.scene, request.options, request.sampling);
  });
  if (bar) picture = with_color_bar(picture, *bar);
  progress.finish();
  if (!picture.memory_note.empty()) spdlog::warn("{}: {}", arguments.input, picture.memory_note);
  const std::uint64_t bytes = image_file.commit(picture.image, picture.tone);
  write_report(arguments, request, picture, {backend->name(), loaded, load_s, bytes, bar ? bar->width : 0});
}

}  // namespace

void add_render(CLI::App& app) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "Renders a picture of a NanoVDB file, or of a source");
  command->add_option("input", arguments->input, "NanoVDB file, OUT.nvdb; with --volume dense any input of convert")
      ->type_name("INPUT")
      ->required();
  command->add_option("-o,--output", arguments->output, ".png (sRGB) or .exr (linear)")
      ->type_name("IMAGE.png")
      ->required();
  command
      ->add_option("--volume", arguments->volume,
                   "file: a NanoVDB file in place; dense: a source, all of its voxels in memory")
      ->check(CLI::IsMember({"file", "dense"}))
      ->capture_default_str();
  add_picture_options(*command, arguments->picture);
  add_input_options_of_one(*command, arguments->source);
  add_progress_options(*command, arguments->progress);
  command->add_flag("--overwrite", arguments->overwrite, "replace an existing picture");
  command->add_flag("--json", arguments->json, "report as one JSON object on stdout");
  add_log_level(*command);
  command->callback([arguments] { render(*arguments); });
}

}  // namespace weir
