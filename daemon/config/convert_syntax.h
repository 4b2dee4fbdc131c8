// The options of `weir convert` as keys of a TOML table: "--max-error 2" is
// `max_error = 2`. What the options are is handed in by tools/, on which the
// daemon does not depend.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "format/base/toml_reader.h"

namespace weir {

struct ConvertSyntax {
  struct Option {
    std::string name;  ///< without dashes: "max-error"
    bool flag;         ///< takes no value
    bool path;         ///< is a file, looked for beside the configuration
  };
  std::vector<Option> options;  ///< those that a watch may set
  /// Throws Error(usage) where `weir convert` would refuse `arguments`, such as {"--rate=8", "--stack"}.
  std::function<void(const std::vector<std::string>& arguments)> check;
  std::uint64_t least_memory = 0;  ///< bytes below which a conversion refuses to run
};

/// The arguments that the keys of `table` stand for, in the order of `syntax`. A value is a string, a number, an
/// array of them (joined by commas) or, of a flag, a boolean. Throws Error(input) at the key that
/// ConvertSyntax::check refuses, its message in terms of keys. `reader` is the one of `table`.
std::vector<std::string> read_convert_options(TomlReader& reader, const toml::table& table,
                                              const ConvertSyntax& syntax);

}  // namespace weir
