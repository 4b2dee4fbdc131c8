// The options of `weir convert` as keys of a TOML table: "--max-error 2" is
// `max_error = 2`.
#pragma once

#include <string>
#include <vector>

#include "format/base/toml_reader.h"

namespace weir {

/// The arguments of `weir convert` that the keys of `table` stand for: {"--rate=8", "--lossless"}. The keys are the
/// input options, but for `stack`, and those of the method (compressor/options). A value is a string, a number, an
/// array of them (joined by commas) or, of a flag, a boolean; a scene is looked for beside the configuration. Throws
/// Error(input) at the key that `weir convert` would refuse, for the same reason, a scene's with its own path and place
/// behind that of the key. `reader` is the one of `table`.
std::vector<std::string> read_watch_options(TomlReader& reader, const toml::table& table);

}  // namespace weir
