// The digest of a file on disk, its pieces read and hashed by all threads.
#pragma once

#include <cstdint>
#include <functional>

#include "compressor/team/team.h"
#include "format/io/digest.h"
#include "format/io/file_system.h"

namespace weir {

/// Of all of `file`, each rank reading its share. `advanced`, where there is one, is called from the calling thread
/// with the bytes that this rank has read so far; what it throws ends the work.
Digest digest_of_file(File& file, Team& team, const std::function<void(std::uint64_t)>& advanced = {});

}  // namespace weir
