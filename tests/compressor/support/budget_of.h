// A budget by its kind and number.
#pragma once

#include "compressor/select/budget.h"

namespace weir {

/// `value`: the rate of Kind::rate, else the target.
inline Budget budget_of(Budget::Kind kind, double value) {
  Budget budget;
  budget.kind = kind;
  (kind == Budget::Kind::rate ? budget.rate : budget.target) = value;
  return budget;
}

}  // namespace weir
