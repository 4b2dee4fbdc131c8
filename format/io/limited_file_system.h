// A file system whose files keep to a bandwidth, spill files among them.
#pragma once

#include <memory>

#include "format/io/bandwidth.h"
#include "format/io/file_system.h"

namespace weir {

/// Both must outlive the result and its files.
std::unique_ptr<FileSystem> limit_file_system(FileSystem& files, Bandwidth& bandwidth);

}  // namespace weir
