// Which array of a Zarr hierarchy becomes the volume.
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

/// An array and what is known of it.
struct ChosenArray {
  ZarrNode node;
  ZarrArray array;
  ArrayMeaning meaning;
};

/// options.dataset, a key or, where that is an image of several scales, its finest level. Empty: the finest level of
/// the image that the root is, or the only array that is a volume, levels other than the finest aside; with
/// options.component the only one of vectors, where there are some. Throws Error(usage),
/// with the commands, where there are several; arrays that cannot be converted are said to options.notice; Error(input)
/// where there is none of that name or none is a volume.
ChosenArray choose_array(ZarrStore& store, const std::string& path, const SourceOptions& options);

/// What `weir inspect` lists of all arrays. Damaged metadata are the obstacle of their array. Throws Error(input) where
/// there is none.
std::vector<DatasetInfo> list_arrays(ZarrStore& store, const std::string& path);

}  // namespace weir
