// weir flip: measures how different two pictures look.
#include <CLI/CLI.hpp>
#include <chrono>
#include <initializer_list>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/io/file_id.h"
#include "format/io/file_system.h"
#include "gpu/image/colormap.h"
#include "gpu/image/flip.h"
#include "gpu/image/image_output.h"
#include "gpu/image/png_input.h"
#include "tools/command.h"
#include "tools/plot/color_bar.h"

namespace weir {
namespace {

struct FlipArguments {
  std::string reference;
  std::string test;
  std::string output;
  double pixels_per_degree = kFlipPixelsPerDegree;
  bool colorbar = false;
  bool overwrite = false;
  bool json = false;
};

void check(const FlipArguments& arguments, const Image& reference, const Image& test) {
  if (!(arguments.pixels_per_degree >= kFlipMinPixelsPerDegree &&
        arguments.pixels_per_degree <= kFlipMaxPixelsPerDegree)) {
    throw Error(ErrorKind::usage, cat("--ppd is ", arguments.pixels_per_degree, ", it must be from ",
                                      kFlipMinPixelsPerDegree, " to ", kFlipMaxPixelsPerDegree));
  }
  if (reference.width != test.width || reference.height != test.height) {
    throw Error(ErrorKind::usage,
                cat(arguments.test, ": ", test.width, " x ", test.height, " pixels, but ", arguments.reference, " has ",
                    reference.width, " x ", reference.height, "; give two pictures of one size"));
  }
}

nlohmann::ordered_json to_json(const FlipArguments& arguments, const Image& image, const FlipSummary& summary,
                               double total_s) {
  return {{"reference", arguments.reference},
          {"test", arguments.test},
          {"width", image.width},
          {"height", image.height},
          {"pixels_per_degree", arguments.pixels_per_degree},
          {"mean", summary.mean},
          {"median", summary.median},
          {"weighted_median", summary.weighted_median},
          {"first_weighted_quartile", summary.first_weighted_quartile},
          {"third_weighted_quartile", summary.third_weighted_quartile},
          {"min", summary.min},
          {"max", summary.max},
          {"total_s", total_s}};
}

void print_text(const FlipSummary& summary) {
  const auto line = [](const char* name, double value) { std::cout << cat(name, short_number(value), '\n'); };
  line("mean                     ", summary.mean);
  line("median                   ", summary.median);
  line("weighted median          ", summary.weighted_median);
  line("1st weighted quartile    ", summary.first_weighted_quartile);
  line("3rd weighted quartile    ", summary.third_weighted_quartile);
  line("min                      ", summary.min);
  line("max                      ", summary.max);
}

// Draws the map of `errors`, with a colour bar if asked for.
Picture draw_map(const FlipArguments& arguments, std::span<const float> errors, const Image& reference) {
  Picture map;
  map.image = flip_picture(errors, reference.width, reference.height);
  map.tone = {.exposure = 1, .soft_clip = false};
  if (!arguments.colorbar) return map;
  std::vector<Rgba> colors;
  for (const Float3& color : colormap("magma", 256)) colors.push_back({color.x, color.y, color.z, 1});
  return with_color_bar(map, draw_color_bar(TransferFunction(std::move(colors), 0, 1), "FLIP error", reference.height));
}

void flip(const FlipArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const Image reference = read_png(arguments.reference);
  const Image test = read_png(arguments.test);
  check(arguments, reference, test);
  const std::unique_ptr<FileSystem> files = make_posix_file_system();
  std::optional<ImageFile> map;
  if (!arguments.output.empty()) {
    if (!arguments.output.ends_with(".png")) {
      throw Error(ErrorKind::usage, cat("--output is \"", arguments.output, "\", it must end in .png"));
    }
    require_not_input(file_ids(std::array{arguments.reference, arguments.test}), arguments.output);
    map.emplace(*files, arguments.output, arguments.overwrite);
  }

  const std::vector<float> errors = flip_errors(reference, test, arguments.pixels_per_degree);
  if (map) {
    const Picture picture = draw_map(arguments, errors, reference);
    map->commit(picture.image, picture.tone);
  }
  const FlipSummary summary = summarise_flip(errors);
  if (arguments.json) {
    const nlohmann::ordered_json report = to_json(arguments, reference, summary, seconds_since(start));
    std::cout << json_text(report) << '\n';
  } else {
    print_text(summary);
  }
}

}  // namespace

void add_flip(CLI::App& app) {
  auto arguments = std::make_shared<FlipArguments>();
  CLI::App* command = app.add_subcommand("flip", "Measures how different two pictures look, with the FLIP metric");
  command->add_option("reference", arguments->reference, "the picture as it should be, a PNG of 8 bits")
      ->required()
      ->type_name("REFERENCE.png");
  command->add_option("test", arguments->test, "the one to judge, of the same size")->required()->type_name("TEST.png");
  command
      ->add_option("-o,--output", arguments->output,
                   "picture of the errors in the colours of \"magma\": black where the pictures look the same")
      ->type_name("MAP.png");
  command
      ->add_option("--ppd", arguments->pixels_per_degree,
                   "pixels per degree of the viewer's sight; default: 67.02, 3840 pixels over 0.7 m seen from 0.7 m")
      ->type_name("N");
  command
      ->add_flag("--colorbar", arguments->colorbar, "with --output: draws which error has which colour beside the map")
      ->needs("--output");
  command->add_flag("--overwrite", arguments->overwrite, "replace an existing picture of the errors");
  command->add_flag("--json", arguments->json, "one JSON object on stdout");
  add_log_level(*command);
  command->footer(
      "Errors are 0 where nobody sees a difference, 1 at most. A weighted percentile is the error up to which the\n"
      "smaller ones make that share of the sum of all errors. Andersson et al., FLIP: A Difference Evaluator for\n"
      "Alternating Images, HPG 2020.");
  command->callback([arguments] { flip(*arguments); });
}

}  // namespace weir
