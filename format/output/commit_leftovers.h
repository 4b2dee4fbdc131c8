// Recognises what a killed commit left beside an output, and tells it from other people's files.
#pragma once

#include <string>

#include "format/io/file_system.h"

namespace weir {

/// Returns the text that OUT.nvdb.partial holds if it is only a lock while a sidecar of `sidecar_text` is put into
/// place.
std::string commit_record(const std::string& sidecar_text);

/// Returns whether `sidecar` is a sidecar of weir that describes the file `volume`: by length, head checksum and, if
/// these agree, the digest of all its bytes (length and head checksum also agree for volumes of equal range and
/// topology). False if either file is missing. Throws Error(io) if either exists but cannot be read: then nothing is
/// known, and all files must stay.
bool describes(FileSystem& files, const std::string& sidecar, File& volume);
bool describes(FileSystem& files, const std::string& sidecar, const std::string& volume);

enum class OwnSidecar { in_place, previous, neither };

/// Returns which of `previous` and `sidecar` (the sidecar in place) describes `volume`. Reads the volume once, or not
/// at all if `sidecar` has another length or head checksum. Throws as describes().
OwnSidecar find_own_sidecar(FileSystem& files, const std::string& previous, const std::string& sidecar,
                            const std::string& volume);

/// Returns whether find_own_sidecar() is `previous`: a commit was killed before it replaced the volume. Throws as
/// describes().
bool belongs_back(FileSystem& files, const std::string& previous, const std::string& sidecar,
                  const std::string& volume);

/// Returns whether a killed commit, with `partial` as its OUT.nvdb.partial, put `sidecar` into its place. Throws as
/// describes().
bool placed_by_commit(FileSystem& files, const std::string& sidecar, File& partial);

/// Returns whether a commit as in placed_by_commit() was killed before it replaced `volume`: `sidecar` does not
/// describe `volume`, which had no sidecar. Throws as describes().
bool came_too_early(FileSystem& files, const std::string& sidecar, const std::string& volume, File& partial);

/// Returns whether OUT.nvdb.partial is the lock of a commit that was completed but killed before it removed the data
/// that the output was made from. False if that cannot be known.
bool is_committed(FileSystem& files, const std::string& output);

}  // namespace weir
