// The dataset that is meant where the user names none.
#pragma once

#include <string>

#include "ingest/hdf5/file/hdf5_object.h"
#include "ingest/source/source_options.h"

namespace weir {

/// The only dataset of `file`, whose path is `path`, that can be converted; where options.index or options.component is
/// given, the only one that takes it, unless none does. Throws Error(usage), with the command for each, where there are
/// several, Error(input), saying why, where there is none. Volumes that cannot be converted are said to options.notice.
/// The caller holds Hdf5Lock.
Hdf5Object only_volume(hid_t file, const std::string& path, const SourceOptions& options);

}  // namespace weir
