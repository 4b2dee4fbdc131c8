// What a commit that was killed leaves beside an output, and how weir tells it from other people's files.
#pragma once

#include <string>

#include "format/io/file_system.h"

namespace weir {

/// What OUT.nvdb.partial holds while it is a lock alone and a sidecar of `sidecar_text` is put into place.
std::string commit_record(const std::string& sidecar_text);

/// Whether `sidecar` is a sidecar of weir and `volume` the file that it describes: by length, head checksum and, where
/// these agree, which they also do for volumes of equal range and topology, the digest of all its bytes. False where
/// one of them is missing. Throws Error(io) where one is there and cannot be read: then nothing is known, and all must
/// stay as it is.
bool describes(FileSystem& files, const std::string& sidecar, File& volume);
bool describes(FileSystem& files, const std::string& sidecar, const std::string& volume);

enum class OwnSidecar { in_place, previous, neither };

/// Which of `previous` and `sidecar`, which lies in its place, describes `volume`. The volume is read once, and not at
/// all where the length or the head checksum of `sidecar` is another. Throws as describes().
OwnSidecar find_own_sidecar(FileSystem& files, const std::string& previous, const std::string& sidecar,
                            const std::string& volume);

/// Whether it is `previous`: a commit was killed before it replaced the volume. Throws as describes().
bool belongs_back(FileSystem& files, const std::string& previous, const std::string& sidecar,
                  const std::string& volume);

/// Whether a commit that was killed, whose OUT.nvdb.partial was `partial`, put `sidecar` into its place. Throws as
/// describes().
bool placed_by_commit(FileSystem& files, const std::string& sidecar, File& partial);

/// Whether such a commit was killed before it replaced `volume`, beside which no sidecar lay: `sidecar` is not of it.
/// Throws as describes().
bool came_too_early(FileSystem& files, const std::string& sidecar, const std::string& volume, File& partial);

/// Whether OUT.nvdb.partial is the lock of a commit that was completed, but was killed before it removed what the
/// output was made from. False where that cannot be known.
bool is_committed(FileSystem& files, const std::string& output);

}  // namespace weir
