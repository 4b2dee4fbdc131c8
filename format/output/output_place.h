// Checks which names an output may have, and gives it its name step by step. For a volume and for any other file that
// weir makes.
#pragma once

#include <cstddef>
#include <string>

#include "format/base/error.h"
#include "format/io/file_system.h"

namespace weir {

/// Throws Error(io) if the directory of `path` is missing. Throws Error(usage) if something that is not a regular file
/// is at `path`, or if its name is too long for weir's own names beside it, which are up to `beside` bytes longer.
void require_place(FileSystem& files, const std::string& path, std::size_t beside);

/// Returns Error(usage) for an output that exists and must not be replaced.
Error existing_output(const std::string& path);

/// Throws existing_output() if `path` exists: without --overwrite nothing is replaced.
void refuse_existing(FileSystem& files, const std::string& path);

/// Throws Error(usage) for a name that is not meant for a NanoVDB file: "-", a stream, and names with the extension of
/// another known format, such as NAME.vdb or NAME.PNG. Any other extension is accepted.
void require_volume_name(const std::string& path);

/// Throws Error(io) if `partial`, PATH.partial, existed before and may have a writer that no lock shows.
void require_alone(const File& partial);

/// Throws Error(io) if `written` has lost its name while it was written: a rename of that name would give the output
/// another process's file.
void require_named(const File& written);

/// Renames the file `written` to `path` by FileSystem::rename_new(). Throws Error(io) with EEXIST and a remedy if
/// `path` has appeared in the meantime.
void place_new(FileSystem& files, const std::string& written, const std::string& path);

/// Makes the name of `path`, a complete and flushed file, durable. Throws Error(io) that says that the file is there.
void flush_name(FileSystem& files, const std::string& path);

}  // namespace weir
