// Conflicts between two watches, or within one.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "daemon/config/config.h"

namespace weir {

/// Returns whether `path` is `directory` or lies below it on disk. Symbolic links are followed as far as they exist.
bool is_within(const std::string& path, const std::string& directory);

struct WatchConflict {
  std::size_t watch;    ///< index of the watch that must be changed
  std::string key;      ///< key of this watch that must be changed: "label", "directory", "output", "source"
  std::string message;  ///< what is wrong and what to do
};

/// Returns the first conflict: a label used twice; a watched directory inside an output directory, so that outputs
/// would be converted again; two watches that write the same names into one output, or that both convert a source and
/// may write the same name for it; a watch that deletes the sources of another one.
std::optional<WatchConflict> find_conflict(std::span<const WatchConfig> watches);

}  // namespace weir
