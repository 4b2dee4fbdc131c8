// weir play: renders a series of NanoVDB files as frames, PNG files or raw RGB for an encoder.
#include <spdlog/spdlog.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/text.h"
#include "format/io/file_id.h"
#include "format/io/file_system.h"
#include "gpu/image/image_output.h"
#include "gpu/render/playback.h"
#include "tools/command.h"
#include "tools/options/backend_choice.h"
#include "tools/options/picture_options.h"
#include "tools/options/result_directory.h"
#include "tools/options/volume_series.h"
#include "tools/plot/color_bar.h"
#include "tools/report/opacity_warning.h"
#include "tools/report/progress.h"
#include "tools/report/quantity_title.h"
#include "tools/report/standard_output.h"
#include "tools/report/surface_warning.h"

namespace weir {

namespace {

struct PlayArguments {
  std::vector<std::string> inputs;
  std::string output;
  std::string raw;
  GivenOptions picture;
  ProgressOptions progress;
  bool json = false;
};

void check_output(const PlayArguments& arguments) {
  if (arguments.output.empty() == arguments.raw.empty()) throw usage_error("give one of -o DIR and --raw -");
  if (!arguments.raw.empty() && arguments.raw != "-") {
    throw usage_error(cat("--raw is \"", arguments.raw, "\", it must be -, frames on stdout; redirect it to a file"));
  }
  if (!arguments.raw.empty() && arguments.json)
    throw usage_error("--json and --raw - both take stdout; leave one of them out");
}

std::string frame_path(const std::string& directory, std::size_t frame) {
  std::ostringstream name;
  name << "frame_" << std::setw(5) << std::setfill('0') << frame << ".png";
  return (std::filesystem::path(directory) / name.str()).string();
}

void write_stdout(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw stdout_error(errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

// Refuses a frame that would replace one of the inputs of any frame.
void refuse_inputs(const PlayArguments& arguments, const PictureRequest& request,
                   std::span<const std::string> volumes) {
  std::vector<std::string> inputs = picture_inputs(arguments.picture, request);
  inputs.insert(inputs.end(), volumes.begin(), volumes.end());
  const std::vector<FileId> ids = file_ids(inputs);
  for (std::size_t frame = 0; frame < volumes.size(); ++frame) {
    require_not_input(ids, frame_path(arguments.output, frame));
  }
}

// Returns the writer of the frames. The directory is tried before the work.
FrameWriter open_output(const PlayArguments& arguments, FileSystem& files) {
  if (!arguments.raw.empty()) {
    return [](std::size_t, const Picture& picture) { write_stdout(encode_rgb24(picture.image, picture.tone)); };
  }
  { const ImageFile tried(files, frame_path(arguments.output, 0), true); }
  return [&arguments, &files](std::size_t frame, const Picture& picture) {
    ImageFile(files, frame_path(arguments.output, frame), true).commit(picture.image, picture.tone);
  };
}

void warn_of_longer_series(const PlayArguments& arguments, FileSystem& files, std::size_t frames) {
  if (!arguments.raw.empty()) return;
  if (const std::string next = frame_path(arguments.output, frames); files.exists(next)) {
    spdlog::warn("{}: is from a longer series; this one ends before it", next);
  }
}

// Fixes one look for all steps: transfer function, background and framing must not change from step to step.
void fix_look(PictureRequest& request, std::span<const std::string> files) {
  const SeriesSummary series = summarise_series(files);
  if (series.range) {
    if (const std::string line = surface_warning(request.scene, *series.range); !line.empty()) {
      spdlog::warn("{}", line);
    }
  }
  if (!request.scene.volume.range && !series.without_range.empty()) {
    spdlog::warn("{}: names no finite range of its values, and has no certificate that does; {}; give --range LOW,HIGH",
                 series.without_range,
                 series.range ? "the colours of all frames are made without it" : "each frame has colours of its own");
  }
  if (!series.turned.empty()) spdlog::warn("{}", series.turned);
  if (!series.difference.empty()) spdlog::warn("{}; the camera frames each step's own box", series.difference);
  if (!request.scene.volume.range && series.range) {
    request.scene.volume.range = {series.range->min, series.range->max};
  }
  request.options.background = series.background;
  request.scene.camera.framing = Framing::volume;
}

// Returns the colour bar, which is the same for all frames because the colours are.
std::optional<Image> bar_of_series(const PictureRequest& request, const std::string& first) {
  if (!request.colorbar) return std::nullopt;
  if (!request.scene.volume.range) {
    throw Error(ErrorKind::usage, compose(option("colorbar"), " needs ", option("range", "LOW,HIGH"), ": ", first,
                                          " names no range of its values"));
  }
  const VolumeInfo info{{}, {}, request.options.background.value_or(0)};
  return draw_color_bar(picture_transfer(info, request.scene, request.options), quantity_title(NvdbFile(first)),
                        request.options.height);
}

nlohmann::json to_json(const PlayArguments& arguments, const PictureRequest& request, const PlaybackReport& report,
                       std::string_view backend, std::int32_t bar_width) {
  const auto& range = request.scene.volume.range;
  return {{"output", arguments.output},
          {"frames", report.frames},
          {"width", request.options.width + bar_width},
          {"height", request.options.height},
          {"colorbar_width", bar_width},
          {"mode", render_mode_name(request.scene.mode)},
          {"filter", filter_name(request.options.filter)},
          {"backend", backend},
          {"samples", request.sampling.samples},
          {"seed", request.options.seed},
          {"range", range ? nlohmann::json(*range) : nlohmann::json()},
          {"load",
           {{"way", report.load.way},
            {"bytes", report.load.bytes},
            {"memory_bytes", report.load.memory},
            {"note", report.load.note}}},
          {"steps_per_s", report.sustained},
          {"limit", report.limit()},
          {"total_s", report.total_s},
          {"load_s", report.load_s},
          {"render_s", report.render_s},
          {"write_s", report.write_s}};
}

void say_report(const PictureRequest& request, const PlaybackReport& report, const std::string& last,
                std::int32_t bar_width) {
  if (report.load.way == "cached") spdlog::info("{}: {}", last, report.load.note);
  spdlog::info("{} frames of {} x {}, {:.2f} steps/s; load {:.2f} s, render {:.2f} s, write {:.2f} s: {} is the limit",
               report.frames, request.options.width + bar_width, request.options.height, report.sustained,
               report.load_s, report.render_s, report.write_s, report.limit());
}

void play_series(const PlayArguments& arguments) {
  check_output(arguments);
  PictureRequest request = read_picture_request(arguments.picture);
  request.sampling.cancel = &interrupt_flag();
  const std::vector<std::string> volumes = expand_volumes(arguments.inputs);
  if (volumes.size() > 1) request.backend.memory.volumes = 2;  // play() holds two volumes
  const std::unique_ptr<Backend> backend = make_backend(request.backend, warn);
  const std::unique_ptr<FileSystem> files = make_posix_file_system();
  std::optional<ResultDirectory> directory;
  if (!arguments.output.empty()) {
    directory.emplace(*files, arguments.output);
    refuse_inputs(arguments, request, volumes);
  }
  const FrameWriter write = open_output(arguments, *files);
  fix_look(request, volumes);
  if (const std::string line = opacity_warning(request.scene); !line.empty()) {
    spdlog::warn("{}: {}", arguments.picture.at("scene"), line);
  }
  const std::optional<Image> bar = bar_of_series(request, volumes.front());
  const std::int32_t bar_width = bar ? bar->width : 0;

  Progress progress(arguments.progress);
  progress.start(cat("play, ", render_mode_name(request.scene.mode)), request.pixel_samples() * volumes.size(),
                 ProgressUnit::samples);
  std::uint64_t before = 0;  // samples of the previous frames; each frame counts from 0
  std::uint64_t last = 0;
  request.sampling.progress = [&](std::uint64_t done) {
    if (done < last) before += request.pixel_samples();
    last = done;
    progress.update(before + done);
  };
  std::atomic<std::size_t> written{0};
  bool warned = false;
  PlaybackReport report;
  try {
    report = play(*backend, volumes, request.scene, request.options, request.sampling,
                  [&](std::size_t frame, const Picture& picture) {
                    if (!picture.memory_note.empty() && !std::exchange(warned, true)) {
                      spdlog::warn("{}: {}", volumes[frame], picture.memory_note);
                    }
                    if (bar) {
                      write(frame, with_color_bar(picture, *bar));
                    } else {
                      write(frame, picture);
                    }
                    ++written;
                  });
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::interrupted) throw;
    throw Error(ErrorKind::interrupted, cat("interrupted; ", written, " of ", volumes.size(), " frames were written"));
  }
  progress.finish();
  warn_of_longer_series(arguments, *files, volumes.size());
  if (arguments.json) {
    std::cout << json_text(to_json(arguments, request, report, backend->name(), bar_width), 2) << '\n';
  } else {
    say_report(request, report, volumes.back(), bar_width);
  }
}

}  // namespace

void add_play(CLI::App& app) {
  auto arguments = std::make_shared<PlayArguments>();
  CLI::App* command = app.add_subcommand("play", "Renders a series of NanoVDB files, a frame of each");
  command
      ->add_option(
          "input", arguments->inputs,
          "NanoVDB files, or patterns in quotes, 'out/*.nvdb' or 'out/step_%d.nvdb'; step_9 comes before step_10")
      ->type_name("OUT.nvdb")
      ->required();
  command->add_option("-o,--output", arguments->output, "for frame_00000.png and so on")->type_name("DIR");
  command->add_option("--raw", arguments->raw, "-: frames on stdout, 8-bit sRGB, 3 bytes a pixel, for an encoder")
      ->type_name("-");
  add_picture_options(*command, arguments->picture);
  add_progress_options(*command, arguments->progress);
  command->add_flag("--json", arguments->json, "report as one JSON object on stdout");
  add_log_level(*command);
  command->callback([arguments] { play_series(*arguments); });
}

}  // namespace weir
