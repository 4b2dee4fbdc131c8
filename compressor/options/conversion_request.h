// The options of a conversion as text, and what they mean: one table for every front end.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "compressor/conversion_options.h"
#include "format/base/index.h"
#include "format/base/option_row.h"
#include "ingest/source/source_options.h"

namespace weir {

/// Program, libraries and threads' stacks take most of this; less leaves nothing to work in.
inline constexpr std::uint64_t kLeastMemory = std::uint64_t{64} << 20U;
/// Limits of a rate: above, no volume has a byte left; below, no disk holds the file.
inline constexpr double kLeastRate = 0x1p-20;
inline constexpr double kMostRate = 0x1p60;

/// What is read, and how it is converted.
struct ConversionRequest {
  SourceOptions source;
  ConversionOptions conversion;
};

using ConversionOption = ReadableOption<ConversionRequest>;

/// What an input does not say itself: dims, type, roi ...
std::span<const ConversionOption> input_options();
/// Budget, method and policy: size, psnr, encoding, scene ...
std::span<const ConversionOption> method_options();
/// How the machine is used and what is kept: memory, threads, resume, overwrite ...
std::span<const ConversionOption> run_options();
/// Whether one of the three tables has it.
bool is_conversion_option(std::string_view key);
/// The row of an option of one of the three tables, which must exist.
const OptionRow& conversion_option(std::string_view key);
/// What can be said of every file that a service watches: input and method, and which device encodes. A stack is many
/// files, the job of a watch is one.
std::vector<OptionRow> watch_options();

/// What `options`, with keys of the three tables, ask for; what is not given has its standard value. Throws
/// Error(usage) naming option, text and form where one cannot be read or two contradict each other; what load_scene
/// throws. Whether the values make sense for a file is for open_source to say.
ConversionRequest read_conversion_request(const GivenOptions& options);

/// Of Levels::separate, whose volumes have voxels without a value: these become the background. Throws Error(usage)
/// where `options` say something else of voxels that hold no data. What read_conversion_request returns is settled.
void settle_gaps(const SourceOptions& source, ConversionOptions& options);

/// "X,Y,Z" of whole numbers of any sign, voxels. Throws Error(usage) naming the option `key`.
Index3 read_dims(std::string_view key, const std::string& text);

}  // namespace weir
