// The command that converts one volume of a file, for people to type.
#pragma once

#include <string>

#include "ingest/source/dataset_info.h"

namespace weir {

/// Returns `text` as one word of a POSIX shell, quoted if necessary.
std::string shell_word(const std::string& text);

/// Returns "weir convert PATH --dataset NAME --index 0,0 --component magnitude", quoted for a shell. The index is
/// that of the first volume; it is written "time=0" if the time axis is not one of the leading axes. A file that is
/// no `container` takes no --dataset.
std::string convert_command(const std::string& path, bool container, const DatasetInfo& dataset);

/// Returns the same choice as configuration files and Python write it: "dataset NAME, index 0,0, component
/// magnitude".
std::string volume_keys(const DatasetInfo& dataset);

}  // namespace weir
