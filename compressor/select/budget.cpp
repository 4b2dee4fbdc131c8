#include "compressor/select/budget.h"

#include "format/base/exact_text.h"
#include "format/base/text.h"

namespace weir {

std::string budget_text(const Budget& budget) {
  const auto& [kind, rate, bytes, target, at_most] = budget;  // a new member does not compile before it is said here
  return cat(static_cast<int>(kind), ' ', exact_text(rate), ' ', bytes, ' ', exact_text(target),
             at_most ? " at most" : "");
}

}  // namespace weir
