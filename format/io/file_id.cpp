#include "format/io/file_id.h"

#include <sys/stat.h>

#include <algorithm>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"

namespace weir {

std::optional<FileId> file_id(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return FileId{status.st_dev, status.st_ino};
}

std::vector<FileId> file_ids(std::span<const std::string> paths) {
  std::vector<FileId> ids;
  for (const std::string& path : paths) {
    if (const auto id = file_id(path)) ids.push_back(*id);
  }
  return ids;
}

void require_not_input(std::span<const FileId> inputs, const std::string& output) {
  for (const std::string_view ending : kOutputEndings) {
    const std::string path = cat(output, ending);
    const std::optional<FileId> there = file_id(path);
    if (!there || std::find(inputs.begin(), inputs.end(), *there) == inputs.end()) continue;
    throw usage_error(cat(path, ": belongs to the input, and writing ", output,
                          " would replace or remove it; choose another output"));
  }
}

}  // namespace weir
