#include "tools/options/table_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "compressor/options/conversion_request.h"
#include "format/base/text.h"
#include "ingest/source/convert_command.h"

namespace weir {

void add_option(CLI::App& command, const OptionRow& row, GivenOptions& given, const std::string& group) {
  const std::string name = cat("--", row.key);
  const auto store = [&given, key = std::string(row.key)](const std::string& text) { given[key] = text; };
  if (row.flag()) {
    command
        .add_flag_callback(
            name, [store] { store("true"); }, row.text())
        ->group(group);
  } else if (row.several) {
    const auto store_all = [store](const std::vector<std::string>& texts) {
      std::string lines;
      for (const std::string& text : texts) lines += cat(lines.empty() ? "" : "\n", text);
      store(lines);
    };
    command.add_option_function<std::vector<std::string>>(name, store_all, row.text())
        ->type_name(std::string(row.argument))
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)  // once or more, one value each time
        ->group(group);
  } else {
    command.add_option_function<std::string>(name, store, row.text())
        ->type_name(std::string(row.argument))
        ->group(group);
  }
}

void add_input_options(CLI::App& command, GivenOptions& given) {
  add_options(command, input_options(), given, "Input");
}

void add_input_options_of_one(CLI::App& command, GivenOptions& given, std::span<const std::string_view> left_out) {
  for (const ConversionOption& option : input_options()) {
    if (option.row.key == "levels" || std::ranges::find(left_out, option.row.key) != left_out.end()) continue;
    add_option(command, option.row.of_one_volume(), given, "Input");
  }
}

std::string input_words(const GivenOptions& given) {
  std::string words;
  for (const ConversionOption& option : input_options()) {
    const auto found = given.find(option.row.key);
    if (found == given.end() || found->second.empty()) continue;
    words += cat(" --", option.row.key);
    if (!option.row.flag()) words += cat('=', shell_word(found->second));
  }
  return words;
}

void add_method_options(CLI::App& command, GivenOptions& given) { add_options(command, method_options(), given); }

std::string given_input_option(const GivenOptions& given, std::span<const std::string_view> allowed) {
  for (const ConversionOption& option : input_options()) {
    const bool ignored = std::find(allowed.begin(), allowed.end(), option.row.key) != allowed.end();
    if (!ignored && given.contains(option.row.key)) return std::string(option.row.key);
  }
  return {};
}

}  // namespace weir
