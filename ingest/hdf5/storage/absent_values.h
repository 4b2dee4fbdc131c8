// Values that a dataset does not have, as messages say it.
#pragma once

#include <string>

#include "format/base/text.h"

namespace weir {

struct AbsentValues {
  std::string what;  ///< "4 of its 8 chunks"
  bool one = false;
  std::string first = {};  ///< " (the first at 0, 0, 16)", where that is known
  bool no_source = false;  ///< of a virtual dataset; else never written

  /// "4 of its 8 chunks were never written".
  std::string text() const {
    return cat(what, no_source ? (one ? " has no source" : " have no source")
                               : (one ? " was never written" : " were never written"));
  }
};

}  // namespace weir
