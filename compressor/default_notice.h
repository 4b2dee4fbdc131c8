// What is said of a file whose size nobody asked for, by what it keeps of the values.
#pragma once

#include <string>

#include "format/base/message.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// One line where the default gave more than its rate, since that would have kept less than kDefaultLeastDb, or where
/// what it gave keeps less than that; else empty. With a scene, of what can be seen.
Message default_notice(const Sidecar& sidecar, const std::string& output);

}  // namespace weir
