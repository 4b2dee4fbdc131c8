// Volumes of a file that cannot be converted: said where another one is taken that nobody named.
#pragma once

#include <span>
#include <string>

#include "format/base/message.h"
#include "ingest/source/dataset_info.h"

namespace weir {

/// A volume that cannot be converted, and why.
struct LeftOut {
  std::string name;
  std::string obstacle;
};

/// Whether `dataset` would be a volume but for its obstacle: it has three axes or more, none of the last three a time,
/// and is not one that is read by its name alone.
bool is_unread_volume(const DatasetInfo& dataset);

/// "PATH: TAKEN is read; left out: NAME: OBSTACLE; NAME: OBSTACLE; and 3 more (weir inspect lists them)".
/// `left_out` is not empty.
Message left_out_notice(const std::string& path, const std::string& taken, std::span<const LeftOut> left_out);

}  // namespace weir
