// A file system that keeps the reads and writes of all its files, spill files too, to a bandwidth.
#pragma once

#include <memory>

#include "format/io/bandwidth.h"
#include "format/io/file_system.h"

namespace weir {

/// Both arguments must outlive the result and its files.
std::unique_ptr<FileSystem> limit_file_system(FileSystem& files, Bandwidth& bandwidth);

}  // namespace weir
