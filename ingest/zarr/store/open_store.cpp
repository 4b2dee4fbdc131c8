#include "ingest/zarr/store/open_store.h"

#include <filesystem>
#include <system_error>

#include "ingest/files/input_directory.h"
#include "ingest/zarr/store/directory_store.h"
#include "ingest/zarr/store/zip_store.h"

namespace weir {

std::unique_ptr<ZarrStore> open_zarr_store(const std::string& path, std::uint64_t memory) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return make_directory_store(path);
  const std::filesystem::path named(path);
  for (const char* const head : kDirectoryHeads) {
    if (named.filename() != head) continue;
    return make_directory_store(named.has_parent_path() ? named.parent_path().string() : ".");
  }
  return make_zip_store(path, memory);
}

}  // namespace weir
