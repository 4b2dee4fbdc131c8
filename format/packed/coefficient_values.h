// The values of a block's coefficients, in the lanes that the host has.
#pragma once

#include "format/packed/block_constants.h"

namespace weir {

/// What decode_block() makes of the 512 coefficients of a transformed block, in place. All of those of planes of x from
/// `planes` on are +0.
void values_of_coefficients(const BlockConstants& constants, float mean, unsigned planes, float* values);

}  // namespace weir
