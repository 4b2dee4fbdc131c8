// How an output gets its place: which names it may have, and the steps that give it one. Of a volume, and of any other
// file that weir makes.
#pragma once

#include <cstddef>
#include <string>

#include "format/io/file_system.h"

namespace weir {

/// Throws Error(io) where the directory of `path` is missing, Error(usage) where its name is too long for weir's own
/// names beside it, the longest of which has `beside` bytes more, or where something else than a regular file is there.
void require_place(FileSystem& files, const std::string& path, std::size_t beside);

/// Throws Error(usage) where `path` is there: without --overwrite nothing is replaced.
void refuse_existing(FileSystem& files, const std::string& path);

/// Throws Error(usage) for names that say that no NanoVDB file is wanted: "-", a stream, and those that end as files of
/// another known format do, NAME.vdb or NAME.PNG. Any other ending will do.
void require_volume_name(const std::string& path);

/// Throws Error(io) where `partial`, PATH.partial, was there before and may have a writer that no lock tells of.
void require_alone(const File& partial);

/// Throws Error(io) where `written` has lost its name while it was written: a rename of that name would give the output
/// whatever another process has there.
void require_named(const File& written);

/// FileSystem::rename_new of what was written to the name `path`; Error(io) of EEXIST with a remedy where something has
/// got that name meanwhile.
void place_new(FileSystem& files, const std::string& written, const std::string& path);

/// Makes the name of `path`, whose file is whole and flushed, durable. Throws Error(io) that says that it is there.
void flush_name(FileSystem& files, const std::string& path);

}  // namespace weir
