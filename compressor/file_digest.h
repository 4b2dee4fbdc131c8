// The digest of a file, on disk or mapped, its pieces read and hashed by all threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "compressor/team/team.h"
#include "format/base/trace.h"
#include "format/io/digest.h"
#include "format/io/file_system.h"

namespace weir {

/// Called from the calling thread with the bytes that this rank has read so far, where there is one; what it throws
/// ends the work.
using DigestAdvanced = std::function<void(std::uint64_t bytes)>;

/// Of all of `file`, each rank reading its share; nothing is read of one that lies in memory.
Digest digest_of_file(File& file, Team& team, const DigestAdvanced& advanced = {});

/// Of a file that is mapped, by this process alone; `trace`, where there is one, gets what each thread hashes.
Digest digest_of_mapping(std::span<const std::byte> file, Trace* trace, const DigestAdvanced& advanced = {});

}  // namespace weir
