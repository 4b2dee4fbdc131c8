// The command that converts one volume of a file, for people to type.
#pragma once

#include <string>

#include "ingest/source/dataset_info.h"

namespace weir {

/// `text` as one word of a POSIX shell, quoted where it has to be.
std::string shell_word(const std::string& text);

/// "weir convert PATH --dataset NAME --index 0,0 --component magnitude", quoted for a shell. The index is that of the
/// first volume, "time=0" where the axis of a time is none of the leading ones. A file that is no `container` takes no
/// --dataset.
std::string convert_command(const std::string& path, bool container, const DatasetInfo& dataset);

/// The same choice as a configuration and Python have it: "dataset NAME, index 0,0, component magnitude".
std::string volume_keys(const DatasetInfo& dataset);

}  // namespace weir
