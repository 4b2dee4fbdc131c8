// Makes a budget from its kind and a number.
#pragma once

#include "compressor/select/budget.h"

namespace weir {

/// Returns a budget of `kind`. `value` is the rate for Kind::rate, otherwise the target.
inline Budget budget_of(Budget::Kind kind, double value) {
  Budget budget;
  budget.kind = kind;
  (kind == Budget::Kind::rate ? budget.rate : budget.target) = value;
  return budget;
}

}  // namespace weir
