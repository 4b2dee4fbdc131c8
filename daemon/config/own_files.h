// The files that the service itself reads and writes.
#pragma once

#include <optional>
#include <string>

#include "daemon/config/config.h"

namespace weir {

struct OwnFileConflict {
  std::string key;      ///< key of [service] that must be changed
  std::string message;  ///< what is wrong and what to do
};

/// Returns the first conflict: the service would overwrite a file that it needs. The written files are state, log,
/// port_file and control_socket, and the files that are made beside them under fixed names. Such a file must be
/// neither a file that the service reads (the configuration, token_file, the scene of a watch) nor that of another of
/// these keys. Symbolic links are followed as far as they exist.
std::optional<OwnFileConflict> find_own_file_conflict(const DaemonConfig& config);

/// Fills WatchConfig::excluded_paths and excluded_numbers.
void exclude_own_files(DaemonConfig& config);

}  // namespace weir
