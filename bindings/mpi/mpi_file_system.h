// Files that all processes of a team write together, through MPI-IO. They take the place of the system's files, which a
// single process uses.
#pragma once

#include <memory>

#include "bindings/mpi/mpi_team.h"
#include "format/io/file_system.h"

namespace weir {

/// Only the leading rank creates, renames and removes files, through `files`, so that locks are taken and space is
/// reserved once. Only that rank needs `files`, which must outlive the result. All ranks call the functions of the file
/// system, and its files' preallocate() and clear(), in the same order. The other functions of files concern only the
/// calling rank; other ranks see what they wrote after Team::publish(). All paths must name the same files on all
/// ranks: a shared file system.
std::unique_ptr<FileSystem> make_mpi_file_system(MpiTeam& team, FileSystem& files);

}  // namespace weir
