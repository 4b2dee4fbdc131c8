// The moments between two blocks of a pass, at which it can say how far it is.
#pragma once

#include <functional>

namespace weir {

struct Pauses {
  std::function<bool()> due;   ///< whether the pass is to bring its state up to date now
  std::function<void()> save;  ///< called when it has
};

}  // namespace weir
