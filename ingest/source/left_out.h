// Volumes of a file that cannot be converted. A notice lists them when weir reads another volume of the file that the
// user did not name.
#pragma once

#include <span>
#include <string>

#include "format/base/message.h"
#include "ingest/source/dataset_info.h"

namespace weir {

/// A volume that cannot be converted, and the reason.
struct LeftOut {
  std::string name;
  std::string obstacle;
};

/// Returns whether only its obstacle keeps `dataset` from being a volume: it has three axes or more, none of the last
/// three is a time, and it is not read by name only.
bool is_unread_volume(const DatasetInfo& dataset);

/// Returns "PATH: TAKEN is read; left out: NAME: OBSTACLE; NAME: OBSTACLE; and 3 more (weir inspect lists them)".
/// `left_out` is not empty.
Message left_out_notice(const std::string& path, const std::string& taken, std::span<const LeftOut> left_out);

}  // namespace weir
