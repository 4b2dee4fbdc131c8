// Computes the values of a block's coefficients in the vector lanes of the host.
#pragma once

#include "format/packed/block_constants.h"

namespace weir {

/// Turns the 512 coefficients of a transformed block into the values that decode_block() returns, in place. All
/// coefficients in planes of x from `planes` on are +0.
void values_of_coefficients(const BlockConstants& constants, float mean, unsigned planes, float* values);

}  // namespace weir
