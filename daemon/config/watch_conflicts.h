// Conflicts between two watches, or within one.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "daemon/config/config.h"

namespace weir {

/// Whether `path` is `directory` or lies below it, both as they are on disk: symbolic links are followed as far as
/// they exist.
bool is_within(const std::string& path, const std::string& directory);

struct WatchConflict {
  std::size_t watch;    ///< index of the watch that has to change
  std::string key;      ///< and which of its keys: "label", "directory", "output", "source"
  std::string message;  ///< what is wrong and what to do
};

/// The first conflict: a label used twice; a watched directory in an output, where what is written would be
/// found and converted; two watches that write the same names into one output, or that both convert a source and may
/// write the same name for it; one that deletes what another one reads.
std::optional<WatchConflict> find_conflict(std::span<const WatchConfig> watches);

}  // namespace weir
