// Names that are empty, as an unset variable leaves them: `-o "$OUT"`.
#pragma once

namespace CLI {
class App;
}

namespace weir {

/// Has every subcommand of `app` that is there by now refuse an empty argument and an empty --output: Error(usage), at
/// the parse.
void refuse_empty_names(CLI::App& app);

}  // namespace weir
