// Adds the options of a table (format/base/option_row.h) to a command line.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "format/base/option_row.h"

namespace CLI {
class App;
}

namespace weir {

/// Adds the option of `row` under the help heading `group`. Its text is stored in `given`, which must live as long as
/// the command.
void add_option(CLI::App& command, const OptionRow& row, GivenOptions& given, const std::string& group = "Options");

template <typename Request>
void add_options(CLI::App& command, std::span<const ReadableOption<Request>> table, GivenOptions& given,
                 const std::string& group = "Options") {
  for (const auto& option : table) add_option(command, option.row, given, group);
}

/// Add the options that describe an input, and the options of budget, method and policy (compressor/options). They are
/// the same for every command that reads or converts a volume.
void add_input_options(CLI::App& command, GivenOptions& given);
void add_method_options(CLI::App& command, GivenOptions& given);

/// Adds the input options for a command that reads one volume: without the options that make several volumes of a
/// file, and without those in `left_out`.
void add_input_options_of_one(CLI::App& command, GivenOptions& given, std::span<const std::string_view> left_out = {});

/// Returns the input options in `given`, which add_input_options_of_one() filled, as shell words with a space before
/// each: " --dims=64,64,64 --type=uint8".
std::string input_words(const GivenOptions& given);

/// Returns the first input option that is given and is not in `allowed`; empty if there is none.
std::string given_input_option(const GivenOptions& given, std::span<const std::string_view> allowed = {});

}  // namespace weir
