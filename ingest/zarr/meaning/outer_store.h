// The groups around an array that is named by its own path.
#pragma once

#include <memory>
#include <string>

#include "ingest/zarr/store/zarr_store.h"

namespace weir {

struct OuterStore {
  std::unique_ptr<ZarrStore> store;  ///< nullptr where there is no group around it
  std::string key;                   ///< of the array, there
};

/// Of `store`, at `path`, where that is an array in a directory: the outermost group that is a directory around it
/// without another one between. Groups whose metadata are damaged are none.
OuterStore outer_store(ZarrStore& store, const std::string& path);

}  // namespace weir
