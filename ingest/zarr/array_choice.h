// Chooses the array of a Zarr hierarchy that becomes the volume.
#pragma once

#include <string>
#include <vector>

#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"
#include "ingest/zarr/meaning/array_meaning.h"
#include "ingest/zarr/meaning/zarr_nodes.h"
#include "ingest/zarr/metadata/zarr_array.h"
#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// An array, its metadata, and their meaning as a volume.
struct ChosenArray {
  ZarrNode node;
  ZarrArray array;
  ArrayMeaning meaning;
};

/// Returns the array options.dataset, a key; if the key names an image of several scales, its finest level. If
/// options.dataset is empty, returns the finest level of the root's image, or else the only array that is a volume;
/// levels other than the finest do not count. With options.component, only arrays of vectors count, if there are any.
/// Reports arrays that cannot be converted to options.notice. Throws Error(usage), with the commands, if there are
/// several volumes, and Error(input) if no array has the name or none is a volume.
ChosenArray choose_array(ZarrStore& store, const std::string& path, const SourceOptions& options);

/// Returns what `weir inspect` lists of all arrays. If an array's metadata are damaged, the error becomes its
/// obstacle. Throws Error(input) if there is no array.
std::vector<DatasetInfo> list_arrays(ZarrStore& store, const std::string& path);

}  // namespace weir
