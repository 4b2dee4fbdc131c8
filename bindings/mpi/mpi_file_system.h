// Files that all processes of a team write together, by MPI-IO: what one process
// does of a conversion with the system's files, a team does with these.
#pragma once

#include <memory>

#include "bindings/mpi/mpi_team.h"
#include "format/io/file_system.h"

namespace weir {

/// Names are given and taken by the leading rank, by `files` (which only it needs to have, and which must outlive the
/// result), so that locks are held and a disk's room is reserved once. All ranks call the functions of the file system,
/// and preallocate and clear of its files, in the same order; the other functions of files concern the calling rank
/// alone, and what they wrote is seen by others after Team::publish. All paths must name the same files everywhere: a
/// shared file system.
std::unique_ptr<FileSystem> make_mpi_file_system(MpiTeam& team, FileSystem& files);

}  // namespace weir
