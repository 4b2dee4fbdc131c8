#include "gpu/volume/level_lattice.h"

#include <algorithm>

namespace weir {

std::uint64_t level_bytes(const LevelLattice& lattice, int first) {
  std::uint64_t texels = 0;
  for (int l = first; l < first + level_count(lattice, first); ++l) texels += lattice.size(l);
  return texels * sizeof(float);
}

int finest_level_within(const LevelLattice& lattice, int wanted, std::uint64_t bytes, std::int32_t longest) {
  constexpr std::uint64_t kMostTexels = std::uint64_t{1} << 31U;  // as table_index() needs
  for (int level = std::clamp(wanted, 1, kMostFinest); level <= kMostFinest; ++level) {
    const Int3 n = lattice.texels(level);
    if (greater(n.x, greater(n.y, n.z)) > longest || lattice.size(level) > kMostTexels) continue;
    if (level_bytes(lattice, level) <= bytes) return level;
  }
  return 0;
}

}  // namespace weir
