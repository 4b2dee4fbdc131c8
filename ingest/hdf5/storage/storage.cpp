#include "ingest/hdf5/storage/storage.h"

#include <array>
#include <string_view>

#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/filters/filter_names.h"
#include "ingest/hdf5/filters/filter_pipeline.h"
#include "ingest/hdf5/filters/library_lzf.h"

namespace weir {
namespace {

StorageKind kind_of(hid_t creation) {
  switch (H5Pget_layout(creation)) {
    case H5D_COMPACT:
      return StorageKind::compact;
    case H5D_CHUNKED:
      return StorageKind::chunked;
    case H5D_VIRTUAL:
      return StorageKind::mapped;
    default:
      return H5Pget_external_count(creation) > 0 ? StorageKind::external : StorageKind::contiguous;
  }
}

// Records the names of the filters. The first filter that neither weir nor the library can undo becomes the obstacle.
void look_at_filters(hid_t creation, Storage& storage) {
  const bool own = own_pipeline(creation).has_value();
  for (int i = 0; i < H5Pget_nfilters(creation); ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    std::array<char, 256> name{};
    const H5Z_filter_t id = H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr,
                                           name.size() - 1, name.data(), nullptr);
    storage.filters.push_back(filter_name(id, name.data()));
    if (own && id == kLzfFilter) offer_lzf();
    if (!own && storage.obstacle.empty() && !library_undoes(id)) {
      storage.obstacle = cat("packed by the filter ", storage.filters.back(), " (", id,
                             "), and no plugin for it is found; ", filter_remedy(id));
    }
  }
}

void look_at_fill(hid_t creation, hid_t type, Storage& storage) {
  storage.fill.assign(H5Tget_size(type), std::byte{0});
  H5D_fill_value_t status = H5D_FILL_VALUE_UNDEFINED;
  if (H5Pfill_value_defined(creation, &status) < 0 || status == H5D_FILL_VALUE_UNDEFINED) return;
  storage.fill_is_set = status == H5D_FILL_VALUE_USER_DEFINED;
  if (H5Pget_fill_value(creation, type, storage.fill.data()) < 0) storage.fill_is_set = false;
}

// Returns whether the library reads unwritten elements as the fill value. With H5D_FILL_TIME_NEVER it leaves the
// memory as it is.
bool gives_fill(hid_t creation) {
  H5D_fill_time_t time = H5D_FILL_TIME_NEVER;
  return H5Pget_fill_time(creation, &time) >= 0 && time != H5D_FILL_TIME_NEVER;
}

}  // namespace

Storage storage_of(hid_t dataset) {
  Storage storage;
  const Hdf5Handle creation(H5Dget_create_plist(dataset));
  const Hdf5Handle type(H5Dget_type(dataset));
  const Hdf5Handle space(H5Dget_space(dataset));
  storage.kind = kind_of(creation.get());
  look_at_filters(creation.get(), storage);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (storage.kind == StorageKind::chunked && rank > 0) {
    storage.chunk.resize(static_cast<std::size_t>(rank));
    if (H5Pget_chunk(creation.get(), rank, storage.chunk.data()) != rank) storage.chunk.clear();
  }
  // A fill value of text or another type without a fixed size is of no use.
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind == H5T_INTEGER || kind == H5T_FLOAT || kind == H5T_ENUM) look_at_fill(creation.get(), type.get(), storage);
  if (storage.obstacle.empty() && H5Sget_simple_extent_npoints(space.get()) > 0 &&
      (storage.kind == StorageKind::contiguous || storage.kind == StorageKind::chunked) &&
      H5Dget_storage_size(dataset) == 0) {
    hsize_t chunks = 0;
    // A size of 0 may also mean that the chunk index cannot be read.
    if (storage.kind == StorageKind::chunked && H5Dget_num_chunks(dataset, space.get(), &chunks) < 0) {
      storage.obstacle = cat(kUncountedChunks, ": ", hdf5_reason());
    } else {
      storage.obstacle = "no value was ever written to it; convert it when its values are there";
      storage.is_all_fill = storage.fill_is_set && gives_fill(creation.get());
    }
  }
  return storage;
}

std::string Storage::text() const {
  constexpr std::array<std::string_view, 5> kNames{"contiguous", "contiguous in other files", "compact", "chunked",
                                                   "virtual: in other datasets"};
  std::string text(kNames[static_cast<std::size_t>(kind)]);
  for (std::size_t i = 0; i < chunk.size(); ++i) text += cat(i == 0 ? " " : " x ", chunk[i]);
  for (const std::string& filter : filters) text += ", " + filter;
  return text;
}

}  // namespace weir
