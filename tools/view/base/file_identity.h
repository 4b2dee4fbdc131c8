// Which file has a path now, so that what is kept of the one before is not taken for it.
#pragma once

#include <string>

#include "format/base/text.h"
#include "ingest/files/file_state.h"

namespace weir {

/// Another text where the file was replaced, cut or written to. A file that is not there has one, too.
inline std::string file_identity(const std::string& path) {
  const FileState now = look_at_file(path);
  return cat(now.device, ' ', now.inode, ' ', now.bytes, ' ', now.mtime_ns, ' ', path);
}

}  // namespace weir
