// Reads the options of `weir convert` from keys of a TOML table: "--max-error 2" is `max_error = 2`.
#pragma once

#include <string>
#include <vector>

#include "format/base/toml_reader.h"

namespace weir {

/// Returns the arguments of `weir convert` that the keys of `table` stand for: {"--rate=8", "--lossless"}. The keys are
/// the input options, except `stack`, and the method options (compressor/options). A value is a string, a number or an
/// array of them. An array is joined by commas, except if the option may be repeated (dataset): then each element
/// becomes an argument. The value of a flag is a boolean. A relative scene path is relative to the configuration's
/// directory. Throws Error(input) at the key that `weir convert` would refuse, with the same reason. For an error in a
/// scene file, the message gives the key's place, then the scene's path and place. `reader` reads `table`.
std::vector<std::string> read_watch_options(TomlReader& reader, const toml::table& table);

}  // namespace weir
