// The moments between two blocks of a pass, when the pass can save its progress.
#pragma once

#include <functional>

namespace weir {

struct Pauses {
  std::function<bool()> due;   ///< returns whether the pass must bring its state up to date now
  std::function<void()> save;  ///< called after the pass has brought its state up to date
};

}  // namespace weir
