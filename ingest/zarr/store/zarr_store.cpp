#include "ingest/zarr/store/zarr_store.h"

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {

std::optional<std::string> ZarrStore::text(const std::string& key) {
  const std::unique_ptr<ZarrObject> object = open(key);
  if (!object) return std::nullopt;
  if (object->size() > kMostMetadataBytes) {
    // A group's document may hold the metadata of everything inside the group. The document of a single array is
    // short.
    throw input_error(shown(key),
                      cat("has ", object->size(), " bytes, more than the ", kMostMetadataBytes,
                          " that metadata may have; if it is a group's, ",
                          is_one_file() ? "unpack the zip file and " : "", "name the array in it by its own path"));
  }
  std::string text(static_cast<std::size_t>(object->size()), '\0');
  object->read(0, std::as_writable_bytes(std::span(text)));
  return text;
}

std::string without_slashes(std::string_view name) {
  while (name.starts_with('/')) name.remove_prefix(1);
  while (name.ends_with('/')) name.remove_suffix(1);
  return std::string(name);
}

std::string joined_key(std::string_view group, std::string_view name) {
  return cat(group, group.empty() || name.empty() ? "" : "/", name);
}

}  // namespace weir
