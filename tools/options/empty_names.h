// Names and values that are empty, as an unset variable leaves them: `-o "$OUT"`, `--output=$OUT`.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weir {

/// Has every subcommand of `app` that is there by now refuse an empty argument and an empty --output: Error(usage), at
/// the parse.
void refuse_empty_names(CLI::App& app);

/// Throws Error(usage) for an option with "=" and nothing behind it, for which the parser takes the next word, and for
/// "-o=NAME", for which it takes "=NAME". `words` are those of the command line; options that no command has are left
/// to the parser.
void refuse_empty_values(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace weir
