// The digest of a file, on disk or mapped. All threads read and hash its pieces.
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

/// If not empty, called on the calling thread with the bytes that this rank has read so far. An exception that it
/// throws ends the work.
using DigestAdvanced = std::function<void(std::uint64_t bytes)>;

/// Returns the digest of the whole `file`. Each rank reads its share. If the file lies in memory, nothing is read.
Digest digest_of_file(File& file, Team& team, const DigestAdvanced& advanced = {});

/// Returns the digest of a mapped file, hashed by this process alone. `trace`, if not null, receives what each thread
/// hashes.
Digest digest_of_mapping(std::span<const std::byte> file, Trace* trace, const DigestAdvanced& advanced = {});

}  // namespace weir
