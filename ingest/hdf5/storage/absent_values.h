// Text about values that a dataset does not have, for messages.
#pragma once

#include <string>

#include "format/base/text.h"

namespace weir {

struct AbsentValues {
  std::string what;  ///< "4 of its 8 chunks"
  bool one = false;
  std::string first = {};  ///< " (the first at 0, 0, 16)", if known
  bool no_source = false;  ///< elements of a virtual dataset without a source; otherwise never written

  /// "4 of its 8 chunks were never written".
  std::string text() const {
    return cat(what, no_source ? (one ? " has no source" : " have no source")
                               : (one ? " was never written" : " were never written"));
  }
};

}  // namespace weir
