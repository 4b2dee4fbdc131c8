#include "tools/report/foreign_file.h"

#include <filesystem>
#include <system_error>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source/convert_command.h"
#include "ingest/source_registry.h"

namespace weir {

bool is_foreign_file(const std::string& path) {
  std::error_code failure;
  return !path.ends_with(".nvdb") && std::filesystem::is_regular_file(path, failure) && !is_nanovdb(path);
}

void refuse_foreign_file(const std::string& path) {
  if (!is_foreign_file(path)) return;
  throw input_error(path, cat("is no NanoVDB file; convert it first: weir convert ", shell_word(path)));
}

}  // namespace weir
