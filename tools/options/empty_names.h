// Refuses empty names and values, such as an unset shell variable leaves them: `-o "$OUT"`, `--output=$OUT`.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weir {

/// Makes every subcommand that `app` has at this time refuse an empty argument and an empty --output. Parsing then
/// throws Error(usage).
void refuse_empty_names(CLI::App& app);

/// Throws Error(usage) for an option that ends with "=" (the parser would take the next word as its value) and for
/// "-o=NAME" (the parser would read "=NAME"). `words` are the words of the command line. Options that no command has
/// are left to the parser.
void refuse_empty_values(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace weir
