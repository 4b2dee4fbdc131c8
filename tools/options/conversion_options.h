// The options that say how to convert: budget, method and policy. The same ones
// for every command that converts.
#pragma once

#include <string>

#include "compressor/conversion.h"

namespace CLI {
class App;
}

namespace weir {

/// The options as given; empty: not given.
struct ConversionArguments {
  std::string non_finite;  ///< error, background or keep
  std::string size;        ///< a size: the file is exactly that long
  std::string rate;        ///< dense float32 bytes / file bytes
  std::string psnr;        ///< dB
  std::string max_error;   ///< in the values' own unit
  bool lossless = false;
  std::string encoding;    ///< auto, float, fpn, fp4, fp8 or fp16
  std::string metric;      ///< sse, farthest, closest or median
  std::string fill;        ///< mean or background
  std::string background;  ///< auto or a finite float32
  std::string brick;       ///< 8, 16 or 32 voxels
  std::string preset;      ///< paper
  std::string scene;       ///< path of a scene that decides what matters
};

/// Adds --nonfinite, --size, --rate, --psnr, --max-error, --lossless, --encoding, --metric, --fill, --background,
/// --brick,
/// --preset and --scene, stored in `arguments`, which must live as long as the command.
void add_conversion_options(CLI::App& command, ConversionArguments& arguments);

/// What they mean: budget, metric, fill, brick, background and policy of ConversionOptions. Throws
/// Error(usage) naming option, text and form where one cannot be read or two contradict each other; what load_scene
/// throws.
ConversionOptions parse_conversion(const ConversionArguments& arguments);

}  // namespace weir
