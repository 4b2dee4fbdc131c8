#include "tools/report/foreign_file.h"

#include <filesystem>
#include <system_error>

#include "ingest/source_registry.h"

namespace weir {

bool is_foreign_file(const std::string& path) {
  std::error_code failure;
  return !path.ends_with(".nvdb") && std::filesystem::is_regular_file(path, failure) && !is_nanovdb(path);
}

}  // namespace weir
