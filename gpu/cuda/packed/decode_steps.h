// How threads decode packed blocks together, in four steps, each of which begins when all threads are done with the one
// before: look_at_blocks, order_blocks, take_magnitudes and make_values; the last two once more for the blocks whose
// magnitudes need more than 16 bits.
//
// For host and device: a Thread says who runs, and lets the others of its warp or group catch up.
#pragma once

#include "gpu/cuda/packed/magnitude_steps.h"
#include "gpu/cuda/packed/sort_steps.h"
#include "gpu/cuda/packed/value_steps.h"
