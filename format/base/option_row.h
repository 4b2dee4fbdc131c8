// One option as a row of a table, from which front ends are made: the command line's options, help, man page and
// completion, a configuration's keys, the lines of docs/options.md. What C and Python are given goes through the same
// rows to be read.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "format/base/error.h"

namespace weir {

struct OptionRow {
  std::string_view key;  ///< as on the command line, without dashes: "max-error"
  std::string_view argument =
      {};                      ///< what stands for its value, "X,Y,Z", or all there are, "auto|on|off"; empty: a flag
  std::string_view unit = {};  ///< of the value; empty: none
  std::string_view standard = {};    ///< the value where none is given, or what takes its place; empty: nothing to say
  std::string_view help;             ///< half a sentence
  std::string_view of_several = {};  ///< what follows it where a command reads several volumes; empty: nothing
  std::string_view group = {};       ///< of the options of one group at most one may be given; empty: no group
  std::string_view excludes = {};    ///< keys that must not be given with it, commas between
  bool several = false;              ///< may be given more than once; its text has a line for each
  bool flag() const { return argument.empty(); }
  /// help, and what follows it.
  std::string meaning() const;
  /// meaning and standard.
  std::string text() const;
  /// Of a command that reads one volume.
  OptionRow of_one_volume() const;
};

/// An option and how its text becomes a member of `Request`.
template <typename Request>
struct ReadableOption {
  OptionRow row;
  /// Throws Error(usage) of wrong_option() where the text cannot be read.
  void (*read)(const OptionRow& row, const std::string& text, Request& request);
};

/// The options of one call by key; a flag's text is "true".
using GivenOptions = std::map<std::string, std::string, std::less<>>;

/// "--rate is "x", it must be FORM".
Error wrong_option(std::string_view key, std::string_view text, const Message& form);
/// A flag's text. Throws Error(usage) where it is neither "true" nor "false".
bool read_flag(const OptionRow& row, const std::string& text);
/// The position of `text` among the choices of `row`. Throws Error(usage) with all of them.
std::size_t read_choice(const OptionRow& row, const std::string& text);

/// Throws Error(usage) where two of the given options exclude each other.
void check_exclusions(const std::vector<OptionRow>& table, const GivenOptions& given);

/// Without those of an empty text, which are not given: a script may pass --roi "$ROI".
GivenOptions without_empty(GivenOptions given);

/// Reads what is given of `options`, without_empty(), into `request`, in the order of the table.
template <typename Request>
void read_options(std::span<const ReadableOption<Request>> options, GivenOptions given, Request& request) {
  given = without_empty(std::move(given));
  std::vector<OptionRow> table;
  for (const auto& option : options) table.push_back(option.row);
  check_exclusions(table, given);
  for (const auto& [row, read] : options) {
    const auto found = given.find(row.key);
    if (found != given.end()) read(row, found->second, request);
  }
}

}  // namespace weir
