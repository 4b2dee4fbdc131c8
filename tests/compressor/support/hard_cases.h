// Volumes that have broken converters: every synthetic kind, needles and single
// voxels, and values at the edges of float32.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "compressor/leaf/fill.h"
#include "tests/compressor/support/memory_volume.h"

namespace weir::test {

struct HardCase {
  std::string name;
  std::function<MemoryVolume()> make;
};
std::ostream& operator<<(std::ostream& out, const HardCase& c);

std::vector<HardCase> hard_cases();

/// How a volume may be converted: with the default, or by either way to treat the NaN and infinities it holds.
std::vector<NonFinitePolicy> policies_of(const MemoryVolume& volume);

}  // namespace weir::test
