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

/// Returns the policies with which a volume can be converted: the default, or both other policies if it holds NaN or
/// infinities.
std::vector<NonFinitePolicy> policies_of(const MemoryVolume& volume);

}  // namespace weir::test
