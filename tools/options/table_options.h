// Options of a table (format/base/option_row.h) on a command line.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "format/base/option_row.h"

namespace CLI {
class App;
}

namespace weir {

/// Adds the option of `row`, under the heading `group` of the help; what is given goes to `given`, which must live as
/// long as the command.
void add_option(CLI::App& command, const OptionRow& row, GivenOptions& given, const std::string& group = "Options");

template <typename Request>
void add_options(CLI::App& command, std::span<const ReadableOption<Request>> table, GivenOptions& given,
                 const std::string& group = "Options") {
  for (const auto& option : table) add_option(command, option.row, given, group);
}

/// The options that say what an input does not say itself, and those of budget, method and policy
/// (compressor/options): the same ones for every command that reads, or converts, a volume.
void add_input_options(CLI::App& command, GivenOptions& given);
void add_method_options(CLI::App& command, GivenOptions& given);

/// The input options of a command that reads one volume: those that make several of a file are not among them, nor are
/// those of `left_out`.
void add_input_options_of_one(CLI::App& command, GivenOptions& given, std::span<const std::string_view> left_out = {});

/// " --dims=64,64,64 --type=uint8": the input options of `given`, which add_input_options_of_one() filled, as words of
/// a shell, a space before each.
std::string input_words(const GivenOptions& given);

/// The first input option that is given, but for those of `allowed`; empty where none is.
std::string given_input_option(const GivenOptions& given, std::span<const std::string_view> allowed = {});

}  // namespace weir
