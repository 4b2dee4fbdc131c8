// One option as a row of a table. The front ends are made from these rows: the command line's options, help, man page
// and completion, a configuration's keys, the lines of docs/options.md. Options given in C and Python are read through
// the same rows.
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
  /// The placeholder of its value, "X,Y,Z", or all choices, "auto|on|off"; empty: a flag.
  std::string_view argument = {};
  std::string_view unit = {};        ///< unit of the value; empty: none
  std::string_view standard = {};    ///< the value if none is given, or what replaces it; empty: nothing to say
  std::string_view help;             ///< half a sentence
  std::string_view of_several = {};  ///< text after `help` if a command reads several volumes; empty: nothing
  std::string_view group = {};       ///< at most one option of a group may be given; empty: no group
  std::string_view excludes = {};    ///< keys that must not be given with it, separated by commas
  bool several = false;              ///< may be given more than once; its text has one line for each
  bool flag() const { return argument.empty(); }
  /// Returns `help` followed by `of_several`.
  std::string meaning() const;
  /// Returns meaning() and `standard`.
  std::string text() const;
  /// Returns the row for a command that reads one volume.
  OptionRow of_one_volume() const;
};

/// An option and how its text becomes a member of `Request`.
template <typename Request>
struct ReadableOption {
  OptionRow row;
  /// Throws Error(usage) of wrong_option() if the text cannot be read.
  void (*read)(const OptionRow& row, const std::string& text, Request& request);
};

/// The options of one call by key; the text of a flag is "true".
using GivenOptions = std::map<std::string, std::string, std::less<>>;

/// Returns the error "--rate is "x", it must be FORM".
Error wrong_option(std::string_view key, std::string_view text, const Message& form);
/// Reads a flag's text. Throws Error(usage) if it is neither "true" nor "false".
bool read_flag(const OptionRow& row, const std::string& text);
/// Returns the position of `text` among the choices of `row`. Throws Error(usage) that lists them all if it is none.
std::size_t read_choice(const OptionRow& row, const std::string& text);

/// Throws Error(usage) if two of the given options exclude each other.
void check_exclusions(const std::vector<OptionRow>& table, const GivenOptions& given);

/// Returns `given` without options of an empty text, which count as not given: a script may pass --roi "$ROI".
GivenOptions without_empty(GivenOptions given);

/// Reads the options that without_empty(given) has into `request`, in the order of the table.
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
