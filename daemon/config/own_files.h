// The files that the service itself reads and writes.
#pragma once

#include <optional>
#include <string>

#include "daemon/config/config.h"

namespace weir {

struct OwnFileConflict {
  std::string key;      ///< of [service], the one that has to change
  std::string message;  ///< what is wrong and what to do
};

/// The first file that would be written over: state, log, port_file or control_socket, or what is made beside one of
/// them under a name of its own, is one that the service reads (the configuration, token_file, the scene of a watch),
/// or that another of those keys has. Symbolic links are followed as far as they exist.
std::optional<OwnFileConflict> find_own_file_conflict(const DaemonConfig& config);

/// Fills WatchConfig::excluded_paths and excluded_numbers.
void exclude_own_files(DaemonConfig& config);

}  // namespace weir
