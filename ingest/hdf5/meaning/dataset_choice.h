// The dataset that is meant where the user names none.
#pragma once

#include <cstddef>
#include <string>

#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// The only dataset of `file`, whose path is `path`, that can be converted and takes `positions` of --index; where
/// there is none of those, the only one that can be converted at all. Throws Error(usage), naming them, where
/// there are several, Error(input), saying why, where there is none. The caller holds Hdf5Lock.
Hdf5Object only_volume(hid_t file, const std::string& path, std::size_t positions);

}  // namespace weir
