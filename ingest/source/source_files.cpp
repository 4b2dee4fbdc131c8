#include "ingest/source/source_files.h"

namespace weir {

std::vector<FileId> source_file_ids(const SourceInfo& info) {
  std::vector<FileId> ids;
  for (const FileState& file : info.files) {
    if (file.exists) ids.push_back({file.device, file.inode});
  }
  if (const auto id = file_id(info.path)) ids.push_back(*id);
  return ids;
}

}  // namespace weir
