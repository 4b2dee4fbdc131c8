// Path patterns like those of shells.
#pragma once

#include <string_view>

namespace weir {

/// Returns whether all of `path` ("sub/a.raw") matches `pattern`. `*` matches any run of bytes and `?` any one byte,
/// but no slash. `[a-z_]` matches one byte of a set, and `[!a-z]` one byte outside it. `\` takes the next byte
/// literally. The component `**` matches any number of components, also none. A dot at the beginning of a component
/// matches only a dot. Names are bytes: there is no encoding and no locale, and letter case counts. The bracket of an
/// unclosed set is a literal bracket.
bool matches_glob(std::string_view pattern, std::string_view path);

/// Returns whether `path` matches an `include` or `exclude` pattern. A pattern with a slash applies to the whole
/// path, a pattern without one to the last component.
bool matches_pattern(std::string_view pattern, std::string_view path);

}  // namespace weir
