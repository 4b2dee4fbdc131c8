// The dataset a user names, or an error that says what there is.
#pragma once

#include <string>

#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// Opens the dataset (or openPMD constant) `name` of `file`, whose path is `path`; a missing first slash is
/// added. Follows soft and external links. Throws Error(input), naming like and other datasets, where it is
/// missing, a group or a link that leads nowhere. The caller holds Hdf5Lock.
Hdf5Object find_dataset(hid_t file, const std::string& path, const std::string& name);

}  // namespace weir
