// Finds the groups around an array that is given by its own path.
#pragma once

#include <memory>
#include <string>

#include "ingest/zarr/store/zarr_store.h"

namespace weir {

struct OuterStore {
  std::unique_ptr<ZarrStore> store;  ///< nullptr if there is no group around the array
  std::string key;                   ///< the array's key in `store`
};

/// If `store`, at `path`, is an array in a directory, returns the outermost group around it. All directories from the
/// array up to this group must be groups. A group with damaged metadata does not count as one.
OuterStore outer_store(ZarrStore& store, const std::string& path);

}  // namespace weir
