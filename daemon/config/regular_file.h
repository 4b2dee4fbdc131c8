// Reads the small files that the configuration consists of. A pipe or a device would make the service wait, or fill its
// memory.
#pragma once

#include <cstdint>
#include <string>

namespace weir {

/// Throws Error(input) if something else than a regular file is at `path`, links followed: the service reads the file
/// again at each reload. Does nothing if nothing is there.
void require_regular_file(const std::string& path);

/// Returns the bytes of the regular file at `path`. Never waits for a writer. Throws Error(input) if it is no regular
/// file or has more than `most_bytes`, else the errors of refused_open().
std::string read_regular_file(const std::string& path, std::uint64_t most_bytes);

}  // namespace weir
