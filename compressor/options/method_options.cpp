// The table of options for budget, method and policy of a conversion.
#include <array>
#include <cmath>

#include "compressor/options/conversion_request.h"

namespace weir {
namespace {

using Request = ConversionRequest;

void read_size(const OptionRow& row, const std::string& text, Request& request) {
  const auto bytes = parse_bytes(text);
  if (is_too_many_bytes(text)) throw wrong_option(row.key, text, "a size of at most 2^62 bytes");
  if (!bytes || *bytes == 0) throw wrong_option(row.key, text, "a size such as 1048577, 64MiB or 1.5GB");
  request.conversion.budget.kind = Budget::Kind::size;
  request.conversion.budget.bytes = *bytes;
}

/// Reads a number from `least` to `most`. Refuses NaN.
double read_number(const OptionRow& row, const std::string& text, double least, double most, std::string_view form) {
  const auto number = parse_double(text);
  if (!number || !(*number >= least && *number <= most)) throw wrong_option(row.key, text, std::string(form));
  return *number;
}

void read_rate(const OptionRow& row, const std::string& text, Request& request) {
  request.conversion.budget.kind = Budget::Kind::rate;
  const double number = parse_double(text).value_or(0);
  const bool positive = number > 0 && std::isfinite(number);
  request.conversion.budget.rate = read_number(
      row, text, kLeastRate, kMostRate,
      cat(positive ? "a number from 2^-20 to 2^60" : "a positive number", ": dense float32 bytes / file bytes"));
}

void read_psnr(const OptionRow& row, const std::string& text, Request& request) {
  request.conversion.budget.kind = Budget::Kind::psnr;
  constexpr double kLeastDecibels = 1e-3;
  constexpr double kMostDecibels = 1000;
  request.conversion.budget.target =
      read_number(row, text, kLeastDecibels, kMostDecibels, "a number of dB from 0.001 to 1000, 60 for instance");
}

void read_max_error(const OptionRow& row, const std::string& text, Request& request) {
  request.conversion.budget.kind = Budget::Kind::max_error;
  request.conversion.budget.target =
      read_number(row, text, 0, 1e300, "a number from 0 to 1e300, in the values' own unit");
}

void read_lossless(const OptionRow& row, const std::string& text, Request& request) {
  if (read_flag(row, text)) request.conversion.budget.kind = Budget::Kind::lossless;
}

void read_encoding(const OptionRow& row, const std::string& text, Request& request) {
  request.conversion.encoding = std::array{Encoding::automatic, Encoding::float32, Encoding::fpn,   Encoding::fp4,
                                           Encoding::fp8,       Encoding::fp16,    Encoding::packed}
                                    .at(read_choice(row, text));
}

void read_background(const OptionRow& row, const std::string& text, Request& request) {
  if (text == "auto") return;
  const auto value = parse_double(text);
  const float rounded = value ? static_cast<float>(*value) : 0.0F;
  if (!value || !std::isfinite(rounded)) throw wrong_option(row.key, text, "auto or a finite float32");
  request.conversion.background = rounded;
}

void read_preset(const OptionRow& row, const std::string& text, Request& request) {
  read_choice(row, text);
  ConversionOptions& options = request.conversion;
  options.encoding = Encoding::float32;
  options.metric = Metric::farthest;
  options.fill = FillMode::background;
  options.paper_background = true;
}

constexpr ConversionOption kMethodOptions[] = {
    {{.key = "nonfinite",
      .argument = "error|background|keep",
      .standard = "error",
      .help = "what becomes of voxels without a number: NaN, infinite and, unless --missing-policy says otherwise, "
              "those that hold no data"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.conversion.non_finite =
           std::array{NonFinitePolicy::error, NonFinitePolicy::background, NonFinitePolicy::keep}.at(
               read_choice(row, text));
     }},
    {{.key = "size",
      .argument = "SIZE",
      .unit = "bytes",
      .help = "the file is exactly that long, 64MiB for instance",
      .group = "budget"},
     read_size},
    {{.key = "rate",
      .argument = "RATE",
      .standard = "8",
      .help =
          "the file is exactly ceil(float32 bytes of the volume / RATE) long: 8 is an eighth of float32, not 8 bits a "
          "voxel as ZFP's rate. Without any budget the rate is 8. Then a volume whose smallest possible file is longer "
          "gets that file, and one of less than 128^3 voxels gets at least 40 dB",
      .group = "budget"},
     read_rate},
    {{.key = "psnr",
      .argument = "DB",
      .unit = "dB",
      .help = "the smallest file of at least that many dB, checked on decoded values",
      .group = "budget"},
     read_psnr},
    {{.key = "max-error",
      .argument = "ABS",
      .unit = "the values'",
      .help =
          "the smallest file in which every voxel is within that of its value as float32, checked on decoded values",
      .group = "budget"},
     read_max_error},
    {{.key = "lossless",
      .help = "the smallest file that preserves every bit of every voxel that holds a value",
      .group = "budget"},
     read_lossless},
    {{.key = "at-most", .help = "with --size or --rate: a shorter file, not padding, where the volume needs less"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.conversion.budget.at_most = read_flag(row, text);
     }},
    {{.key = "encoding",
      .argument = "auto|float|fpn|fp4|fp8|fp16|packed",
      .standard = "auto",
      .help = "leaves: auto (float or fpn, whichever has less error), float, fpn (1 to 16 bits a voxel, chosen for "
              "each leaf), fp4, fp8 or fp16; packed: each 8^3 block coded as a whole, about a fifth of the bytes at "
              "the same "
              "error, for weir's own readers (others see the blocks' means)"},
     read_encoding},
    {{.key = "preview",
      .argument = "auto|on|off",
      .standard = "auto",
      .help =
          "of --encoding packed: on keeps each block's mean in the tree, which is what programs other than weir read; "
          "auto: where that takes at most a tenth of the file"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.conversion.preview = std::array{Preview::automatic, Preview::on, Preview::off}.at(read_choice(row, text));
     }},
    {{.key = "metric",
      .argument = "sse|farthest|closest|median",
      .standard = "sse",
      .help = "what the budget is spent on: sse (squared error saved per byte), farthest, closest or median (the "
              "paper's distances from a brick's range to the background)"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.conversion.metric =
           std::array{Metric::sse, Metric::farthest, Metric::closest, Metric::median}.at(read_choice(row, text));
     }},
    {{.key = "fill", .argument = "mean|background", .standard = "mean", .help = "what dropped blocks read"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.conversion.fill = std::array{FillMode::mean, FillMode::background}.at(read_choice(row, text));
     }},
    {{.key = "background",
      .argument = "VALUE",
      .unit = "the values'",
      .standard = "auto",
      .help = "auto (the most frequent value of the histogram's fullest bin) or a value"},
     read_background},
    {{.key = "brick",
      .argument = "8|16|32",
      .unit = "voxels",
      .standard = "8",
      .help = "granularity of the paper's metrics in voxels"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.conversion.brick = std::array{8, 16, 32}.at(read_choice(row, text));
     }},
    {{.key = "preset",
      .argument = "paper",
      .help = "paper: --encoding float --metric farthest --fill background and the paper's background",
      .excludes = "metric,fill,background"},
     read_preset},
    {{.key = "certify",
      .argument = "values|gradient",
      .standard = "values",
      .help = "what the sidecar certifies; gradient: also the error of the gradient by central differences "
              "(error.gradient), for which source and file are read once more"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.conversion.certify = std::array{Certify::values, Certify::gradient}.at(read_choice(row, text));
     }},
    {{.key = "scene",
      .argument = "SCENE.toml",
      .help = "scene file (as for weir render) that decides what matters: blocks that its opacity, iso value or region "
              "cannot show become tiles, errors count by what it shows of them"},
     [](const OptionRow&, const std::string& text, Request& r) {
       if (!text.empty()) r.conversion.scene = SceneFile{load_scene(text), text};
     }},
};

}  // namespace

std::span<const ConversionOption> method_options() { return kMethodOptions; }

}  // namespace weir
