// The options of a conversion as text and their meaning, in tables that every front end uses.
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

/// Least --memory in bytes. Program, libraries and threads' stacks take most of it; less leaves no memory to work in.
inline constexpr std::uint64_t kLeastMemory = std::uint64_t{64} << 20U;
/// Limits of a rate. Above kMostRate, no volume has a byte left; below kLeastRate, no disk holds the file.
inline constexpr double kLeastRate = 0x1p-20;
inline constexpr double kMostRate = 0x1p60;

/// The source to read, and how to convert it.
struct ConversionRequest {
  SourceOptions source;
  ConversionOptions conversion;
};

using ConversionOption = ReadableOption<ConversionRequest>;

/// Options about the input that the input itself does not tell: dims, type, roi ...
std::span<const ConversionOption> input_options();
/// Options of budget, method and policy: size, psnr, encoding, scene ...
std::span<const ConversionOption> method_options();
/// Options about the use of the machine and about files that are kept: memory, threads, resume, overwrite ...
std::span<const ConversionOption> run_options();
/// Returns whether one of the three tables has the option `key`.
bool is_conversion_option(std::string_view key);
/// Returns the row of the option `key`, which must be in one of the three tables.
const OptionRow& conversion_option(std::string_view key);
/// Returns the options that apply to every file that a service watches: the options of input and method, and which
/// device encodes. "stack" is left out, because a stack is many files and a watch's job is one.
std::vector<OptionRow> watch_options();

/// Returns the request for `options`, whose keys are from the three tables. Options that are not given have their
/// standard values. Throws Error(usage) that names option, text and form if an option cannot be read or two options
/// contradict each other, and the errors of load_scene(). open_source() checks whether the values make sense for a
/// file.
ConversionRequest read_conversion_request(const GivenOptions& options);

/// For Levels::separate, whose volumes have voxels without a value: lets these voxels become the background. Throws
/// Error(usage) if `options` ask for something else for voxels without data. read_conversion_request() has done this
/// for the request that it returns.
void settle_gaps(const SourceOptions& source, ConversionOptions& options);

/// Reads "X,Y,Z": whole numbers of any sign, in voxels. Throws Error(usage) that names the option `key`.
Index3 read_dims(std::string_view key, const std::string& text);

}  // namespace weir
