// weir render: a picture of a NanoVDB file.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "format/error.h"
#include "format/file_system.h"
#include "format/nvdb_file.h"
#include "format/scene.h"
#include "format/text.h"
#include "gpu/image_output.h"
#include "tools/backend_choice.h"
#include "tools/command.h"
#include "tools/progress.h"

namespace weir {

namespace {

constexpr std::int64_t kMaxEdge = 32768;       // pixels
constexpr std::int64_t kMaxPixels = 1 << 28;   // 3 GiB of picture
constexpr std::int64_t kMaxSamples = 1 << 20;  // the mean is a sum of floats
constexpr std::int64_t kMaxThreads = 4096;

/// The command line as given; empty: not given.
struct RenderArguments {
  std::string input;
  std::string output;
  std::string scene;
  std::string mode;
  std::string backend = "auto";
  std::string filter = "trilinear";
  std::string size = "960x720";
  std::string colormap;
  std::string camera;
  std::string iso;
  std::string samples;
  std::string seed = "0";
  std::string threads = "0";
  ProgressOptions progress;
  bool json = false;
};

Error usage(const std::string& message) { return {ErrorKind::usage, message}; }

std::int64_t parse_count(std::string_view option, const std::string& text, std::int64_t low, std::int64_t high) {
  const std::optional<std::int64_t> value = parse_int(text);
  if (!value || *value < low || *value > high) {
    throw usage(cat(option, " is \"", text, "\", it must be a whole number from ", low, " to ", high));
  }
  return *value;
}

void parse_size(const std::string& text, RenderOptions& options) {
  const std::vector<std::string> parts = split(text, 'x');
  const auto bad = [&] {
    return usage(cat("--size is \"", text, "\", it must be WxH in pixels, each from 1 to ", kMaxEdge, " and ",
                     kMaxPixels, " together"));
  };
  if (parts.size() != 2) throw bad();
  const auto width = parse_int(parts[0]);
  const auto height = parse_int(parts[1]);
  if (!width || !height || *width < 1 || *height < 1 || *width > kMaxEdge || *height > kMaxEdge) throw bad();
  if (*width * *height > kMaxPixels) throw bad();
  options.width = static_cast<std::int32_t>(*width);
  options.height = static_cast<std::int32_t>(*height);
}

// AZIMUTH,ELEVATION[,ZOOM]; everything else about a camera is in a scene.
void parse_camera(const std::string& text, SceneCamera& camera) {
  const std::vector<std::string> parts = split(text, ',');
  std::vector<double> numbers;
  for (const std::string& part : parts) {
    if (const auto number = parse_double(part)) numbers.push_back(*number);
  }
  const bool valid = numbers.size() == parts.size() && (numbers.size() == 2 || numbers.size() == 3) &&
                     std::abs(numbers[0]) <= 3600 && std::abs(numbers[1]) <= 90 &&
                     (numbers.size() == 2 || (numbers[2] >= 0.01 && numbers[2] <= 100));
  if (!valid) {
    throw usage(cat("--camera is \"", text, "\", it must be AZIMUTH,ELEVATION[,ZOOM] in degrees,",
                    " elevation from -90 to 90, zoom from 0.01 to 100"));
  }
  camera.position.reset();
  camera.azimuth = numbers[0];
  camera.elevation = numbers[1];
  if (numbers.size() == 3) camera.zoom = numbers[2];
}

// The scene file first, the command line over it.
Scene make_scene(const RenderArguments& arguments) {
  Scene scene = arguments.scene.empty() ? Scene{} : load_scene(arguments.scene);
  if (!arguments.mode.empty()) scene.mode = parse_render_mode(arguments.mode).value_or(scene.mode);
  if (!arguments.colormap.empty()) {
    scene.volume.colormap = arguments.colormap;
    scene.volume.color.clear();
  }
  if (!arguments.camera.empty()) parse_camera(arguments.camera, scene.camera);
  if (!arguments.iso.empty()) {
    const std::optional<double> iso = parse_double(arguments.iso);
    if (!iso || !(std::abs(*iso) <= 3.4e38)) throw usage(cat("--iso is \"", arguments.iso, "\", it must be a number"));
    scene.volume.iso = iso;
  }
  return scene;
}

// Enough that a default picture is clean; the other modes only have edges to smooth.
std::int64_t default_samples(RenderMode mode) { return mode == RenderMode::path ? 32 : 4; }

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void render(const RenderArguments& arguments) {
  const int threads = static_cast<int>(parse_count("--threads", arguments.threads, 0, kMaxThreads));
  const Scene scene = make_scene(arguments);
  RenderOptions options;
  parse_size(arguments.size, options);
  const std::map<std::string, Filter> filters{
      {"nearest", Filter::nearest}, {"trilinear", Filter::trilinear}, {"stochastic", Filter::stochastic}};
  options.filter = filters.at(arguments.filter);
  options.seed = static_cast<std::uint64_t>(parse_count("--seed", arguments.seed, 0, INT64_MAX));
  SampleOptions sampling;
  sampling.samples =
      static_cast<std::uint32_t>(arguments.samples.empty() ? default_samples(scene.mode)
                                                           : parse_count("--spp", arguments.samples, 1, kMaxSamples));
  sampling.cancel = &interrupt_flag();

  const std::unique_ptr<Backend> backend = make_backend(arguments.backend, threads);
  const auto start = std::chrono::steady_clock::now();
  const std::unique_ptr<LoadedVolume> volume =
      backend->load(std::make_shared<const NvdbFile>(arguments.input), 0, nullptr);
  const std::unique_ptr<FileSystem> files = make_posix_file_system();
  ImageFile image_file(*files, arguments.output);
  const double load_s = seconds_since(start);

  const std::uint64_t total =
      static_cast<std::uint64_t>(options.width) * static_cast<std::uint64_t>(options.height) * sampling.samples;
  Progress progress(arguments.progress);
  progress.start(cat("render, ", render_mode_name(scene.mode)), total, ProgressUnit::samples);
  sampling.progress = [&](std::uint64_t done) { progress.update(done); };
  const Picture picture = backend->render(*volume, scene, options, sampling);
  progress.finish();
  const std::uint64_t bytes = image_file.commit(picture.image, picture.tone);
  const LoadSummary& loaded = volume->load_summary();

  if (arguments.json) {
    const nlohmann::json report{
        {"image", arguments.output},
        {"bytes", bytes},
        {"width", options.width},
        {"height", options.height},
        {"mode", render_mode_name(scene.mode)},
        {"filter", arguments.filter},
        {"backend", backend->name()},
        {"samples", sampling.samples},
        {"seed", options.seed},
        {"load", {{"way", loaded.way}, {"bytes", loaded.bytes}, {"transfer_s", loaded.seconds}, {"note", loaded.note}}},
        {"load_s", load_s},
        {"render_s", picture.render_s}};
    std::cout << report.dump(2) << '\n';
  } else {
    spdlog::info("{}: {} x {}, {} samples a pixel, {:.2f} s", arguments.output, options.width, options.height,
                 sampling.samples, picture.render_s);
  }
}

}  // namespace

void add_render(CLI::App& app) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "Renders a picture of a NanoVDB file.");
  command->add_option("input", arguments->input, "NanoVDB file, OUT.nvdb")->required();
  command->add_option("-o,--output", arguments->output, "IMAGE.png (sRGB) or IMAGE.exr (linear)")->required();
  command->add_option("--backend", arguments->backend, "auto, cpu or cuda")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}))
      ->capture_default_str();
  command
      ->add_option("--mode", arguments->mode,
                   "path: multiple scattering; dvr: emission and absorption; iso: surface; mip: largest value")
      ->check(CLI::IsMember({"path", "dvr", "iso", "mip"}));
  command->add_option("--size", arguments->size, "WxH in pixels")->capture_default_str();
  command->add_option("--spp", arguments->samples, "samples a pixel; default 32 for path, 4 for the others");
  command->add_option("--seed", arguments->seed, "of the random numbers; the same seed gives the same picture")
      ->capture_default_str();
  command->add_option("--scene", arguments->scene, "SCENE.toml: camera, transfer function, medium, light");
  command
      ->add_option("--filter", arguments->filter,
                   "trilinear, stochastic (path: as exact, less memory traffic) or nearest")
      ->check(CLI::IsMember({"trilinear", "stochastic", "nearest"}))
      ->capture_default_str();
  command->add_option("--colormap", arguments->colormap, "by name; a wrong one lists them");
  command->add_option("--iso", arguments->iso, "value of the surface; default: 35 % of the way from the background");
  command->add_option("--camera", arguments->camera, "AZIMUTH,ELEVATION[,ZOOM] in degrees; default 35,20,1");
  command->add_option("--threads", arguments->threads, "0: all of the machine's")->capture_default_str();
  add_progress_options(*command, arguments->progress);
  command->add_flag("--json", arguments->json, "report as one JSON object on stdout");
  add_log_level(*command);
  command->callback([arguments] { render(*arguments); });
}

}  // namespace weir
