// Patterns of paths, as shells have them.
#pragma once

#include <string_view>

namespace weir {

/// Whether all of `path` ("sub/a.raw") matches `pattern`. `*` is any run of bytes and `?` any one, neither a slash;
/// `[a-z_]` one of a set and `[!a-z]` one not of it; `\` takes the next byte as it is; the component `**` any
/// number of components, none too. A dot at the beginning of a component matches only a dot. Names are bytes:
/// no encoding, no locale, letter case counts. A set without its end is the bracket itself.
bool matches_glob(std::string_view pattern, std::string_view path);

/// As `include` and `exclude` have them: a pattern with a slash is of the whole path, one without of its last
/// component.
bool matches_pattern(std::string_view pattern, std::string_view path);

}  // namespace weir
