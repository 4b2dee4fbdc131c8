#include "tools/options/conversion_options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

Budget parse_budget(const ConversionArguments& a) {
  const int given = (a.size.empty() ? 0 : 1) + (a.rate.empty() ? 0 : 1) + (a.psnr.empty() ? 0 : 1) +
                    (a.max_error.empty() ? 0 : 1) + (a.lossless ? 1 : 0);
  if (given > 1) throw usage_error("--size, --rate, --psnr, --max-error and --lossless exclude each other; give one");
  Budget budget;
  if (a.lossless) budget.kind = Budget::Kind::lossless;
  if (!a.size.empty()) {
    const auto bytes = parse_bytes(a.size);
    if (!bytes || *bytes == 0) {
      throw usage_error(cat("--size is \"", a.size, "\", it must be a size such as 1048577, 64MiB or 1.5GB"));
    }
    budget.kind = Budget::Kind::size;
    budget.bytes = *bytes;
  }
  if (!a.rate.empty()) {
    const auto rate = parse_double(a.rate);
    // Above 2^60 no volume has a byte left; below 2^-20 no disk holds the file.
    if (!rate || !(*rate >= 0x1p-20 && *rate <= 0x1p60)) {
      throw usage_error(
          cat("--rate is \"", a.rate, "\", it must be a positive number: dense float32 bytes / file bytes"));
    }
    budget.kind = Budget::Kind::rate;
    budget.rate = *rate;
  }
  if (!a.psnr.empty()) {
    const auto target = parse_double(a.psnr);
    if (!target || !(*target >= -1000 && *target <= 1000)) {
      throw usage_error(cat("--psnr is \"", a.psnr, "\", it must be a number of dB, 60 for instance"));
    }
    budget.kind = Budget::Kind::psnr;
    budget.target = *target;
  }
  if (!a.max_error.empty()) {
    const auto target = parse_double(a.max_error);
    if (!target || !(*target >= 0 && *target <= 1e300)) {
      throw usage_error(
          cat("--max-error is \"", a.max_error, "\", it must be a number from 0 on, in the values' own unit"));
    }
    budget.kind = Budget::Kind::max_error;
    budget.target = *target;
  }
  return budget;
}

Encoding parse_encoding(const std::string& name) {
  for (const Encoding encoding :
       {Encoding::automatic, Encoding::float32, Encoding::fpn, Encoding::fp4, Encoding::fp8, Encoding::fp16}) {
    if (encoding_name(encoding) == name) return encoding;
  }
  throw usage_error(cat("--encoding is \"", name, "\", it must be auto, float, fpn, fp4, fp8 or fp16"));
}

Metric parse_metric(const std::string& name) {
  for (const Metric metric : {Metric::sse, Metric::farthest, Metric::closest, Metric::median}) {
    if (metric_name(metric) == name) return metric;
  }
  throw usage_error(cat("--metric is \"", name, "\", it must be sse, farthest, closest or median"));
}

FillMode parse_fill(const std::string& name) {
  for (const FillMode fill : {FillMode::mean, FillMode::background}) {
    if (fill_name(fill) == name) return fill;
  }
  throw usage_error(cat("--fill is \"", name, "\", it must be mean or background"));
}

NonFinitePolicy parse_policy(const std::string& name) {
  for (const NonFinitePolicy policy : {NonFinitePolicy::error, NonFinitePolicy::background, NonFinitePolicy::keep}) {
    if (policy_name(policy) == name) return policy;
  }
  throw usage_error(cat("--nonfinite is \"", name, "\", it must be error, background or keep"));
}

// Empty means "not given" everywhere: the defaults are those of ConversionOptions.
void parse_method(const ConversionArguments& a, ConversionOptions& options) {
  options.encoding = parse_encoding(a.encoding.empty() ? "auto" : a.encoding);
  if (!a.metric.empty()) options.metric = parse_metric(a.metric);
  if (!a.fill.empty()) options.fill = parse_fill(a.fill);
  if (!a.brick.empty()) {
    const auto brick = parse_int(a.brick);
    if (!brick || (*brick != 8 && *brick != 16 && *brick != 32)) {
      throw usage_error(cat("--brick is \"", a.brick, "\", it must be 8, 16 or 32"));
    }
    options.brick = *brick;
  }
  if (!a.preset.empty()) {
    if (a.preset != "paper") throw usage_error(cat("--preset is \"", a.preset, "\", the one there is is paper"));
    for (const auto& [fixed, given] :
         {std::pair{"--metric", a.metric}, std::pair{"--fill", a.fill}, std::pair{"--background", a.background}}) {
      if (!given.empty()) throw usage_error(cat("--preset paper sets ", fixed, "; leave one of them out"));
    }
    if (!a.encoding.empty() && a.encoding != "float")
      throw usage_error("--preset paper sets --encoding; leave one of them out");
    options.encoding = Encoding::float32;
    options.metric = Metric::farthest;
    options.fill = FillMode::background;
    options.paper_background = true;
  }
  if (options.metric != Metric::sse && options.budget.by_error()) {
    throw usage_error(cat("--metric ", a.metric, " has no error target; --psnr and --max-error select by sse"));
  }
  if (options.metric == Metric::sse && options.brick != 8) {
    throw usage_error(
        cat("--brick ", options.brick, " is for --metric farthest, closest or median; sse chooses single leaves"));
  }
  if (!a.background.empty() && a.background != "auto") {
    const auto value = parse_double(a.background);
    const auto rounded = value ? static_cast<float>(*value) : 0.0F;
    if (!value || !(rounded - rounded == 0)) {
      throw usage_error(cat("--background is \"", a.background, "\", it must be auto or a finite float32"));
    }
    options.background = rounded;
  }
}

}  // namespace

void add_conversion_options(CLI::App& command, ConversionArguments& a) {
  command.add_option("--nonfinite", a.non_finite, "what becomes of NaN and infinite voxels; default error")
      ->type_name("error|background|keep");
  command.add_option("--size", a.size, "the file is exactly that long, 64MiB for instance")->type_name("SIZE");
  command.add_option("--rate", a.rate, "the file is exactly ceil(float32 bytes of the volume / RATE) long; default 8")
      ->type_name("RATE");
  command.add_option("--psnr", a.psnr, "the smallest file of at least that many dB, checked on decoded values")
      ->type_name("DB");
  command
      .add_option("--max-error", a.max_error,
                  "the smallest file in which every voxel is within that of its value, checked on decoded values")
      ->type_name("ABS");
  command.add_flag("--lossless", a.lossless, "as long as every bit of every voxel needs");
  command
      .add_option("--encoding", a.encoding,
                  "leaves: auto (float or fpn, whichever has less error), float, fpn (1 to 16 bits a voxel, "
                  "chosen for each leaf), fp4, fp8 or fp16; default auto")
      ->type_name("auto|float|fpn|fp4|fp8|fp16");
  command
      .add_option("--metric", a.metric,
                  "what the budget is spent on: sse (squared error saved per byte), farthest, closest or median "
                  "(the paper's distances from a brick's range to the background); default sse")
      ->type_name("sse|farthest|closest|median");
  command.add_option("--fill", a.fill, "what dropped blocks read; default mean")->type_name("mean|background");
  command.add_option("--background", a.background, "auto (the most frequent value) or a value; default auto")
      ->type_name("VALUE");
  command.add_option("--brick", a.brick, "granularity of the paper's metrics in voxels; default 8")
      ->type_name("8|16|32");
  command
      .add_option("--preset", a.preset,
                  "paper: --encoding float --metric farthest --fill background and the paper's background")
      ->type_name("paper");
  command
      .add_option("--scene", a.scene,
                  "scene file (as for weir render) that decides what matters: blocks that its opacity, iso value or "
                  "region cannot show become tiles, errors count by what it shows of them")
      ->type_name("SCENE.toml");
}

ConversionOptions parse_conversion(const ConversionArguments& a) {
  ConversionOptions options;
  options.budget = parse_budget(a);
  if (!a.non_finite.empty()) options.non_finite = parse_policy(a.non_finite);
  parse_method(a, options);
  if (!a.scene.empty()) options.scene = SceneFile{load_scene(a.scene), a.scene};
  return options;
}

}  // namespace weir
