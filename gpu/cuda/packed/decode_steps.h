// How threads decode packed blocks together. There are four steps: look_at_blocks, order_blocks, take_magnitudes and
// make_values. Each begins when all threads have finished the step before. The last two run once more for the blocks
// whose magnitudes need more than 16 bits.
//
// For host and device: a Thread tells which thread runs, and waits for the other threads of its warp or group.
#pragma once

#include "gpu/cuda/packed/magnitude_steps.h"
#include "gpu/cuda/packed/sort_steps.h"
#include "gpu/cuda/packed/value_steps.h"
