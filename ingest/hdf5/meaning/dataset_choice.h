// Chooses the dataset if the user names none.
#pragma once

#include <string>

#include "ingest/hdf5/file/hdf5_object.h"
#include "ingest/source/source_options.h"

namespace weir {

/// Returns the only dataset of `file`, with the path `path`, that can be converted. If `options.index` or
/// `options.component` is given, returns the only dataset that takes it, unless none does. Throws Error(usage), with
/// the command for each, if there are several, and Error(input), with the reason, if there is none. Reports volumes
/// that cannot be converted to `options.notice`. The caller holds Hdf5Lock.
Hdf5Object only_volume(hid_t file, const std::string& path, const SourceOptions& options);

}  // namespace weir
