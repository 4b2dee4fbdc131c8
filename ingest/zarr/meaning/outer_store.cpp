#include "ingest/zarr/meaning/outer_store.h"

#include <cstddef>
#include <filesystem>
#include <utility>

#include "format/base/error.h"
#include "ingest/files/input_directory.h"
#include "ingest/zarr/meaning/zarr_nodes.h"
#include "ingest/zarr/store/directory_store.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

/// Returns `path`, made absolute if it is a single name or has a part "." or "..": its own text then does not name the
/// directories around it.
fs::path with_parents(const fs::path& path) {
  for (const fs::path& part : path) {
    if (part == "." || part == "..") return fs::absolute(path).lexically_normal();
  }
  return path.has_parent_path() ? path : fs::absolute(path);
}

bool is_group(ZarrStore& store) {
  try {
    const auto node = zarr_node(store, {});
    return node && !node->array;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::interrupted) throw;
    return false;
  }
}

}  // namespace

OuterStore outer_store(ZarrStore& store, const std::string& path) {
  OuterStore outer;
  const auto root = zarr_node(store, {});
  if (store.is_one_file() || !root || !root->array) return outer;
  fs::path at = without_last_slash(std::string(named_by_head(path)));
  std::string key;
  for (std::size_t depth = 0; depth < kMostZarrDepth; ++depth) {
    at = with_parents(at);
    key = joined_key(at.filename().string(), key);
    at = at.parent_path();
    auto around = make_directory_store(at.string());
    if (!is_group(*around)) break;
    outer = {std::move(around), key};
  }
  return outer;
}

}  // namespace weir
