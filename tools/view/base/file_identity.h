// Identifies the file that a path names now, so that data kept of an earlier file are not used for it.
#pragma once

#include <string>

#include "format/base/text.h"
#include "ingest/files/file_state.h"

namespace weir {

/// Returns a text that changes when the file is replaced, cut or written to. A missing file has an identity too.
inline std::string file_identity(const std::string& path) {
  const FileState now = look_at_file(path);
  return cat(now.device, ' ', now.inode, ' ', now.bytes, ' ', now.mtime_ns, ' ', path);
}

}  // namespace weir
