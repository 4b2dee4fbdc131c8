#include "gpu/volume/level_lattice.h"

#include <algorithm>

#include "format/base/error.h"
#include "format/base/message.h"
#include "format/base/text.h"

namespace weir {

std::uint64_t level_bytes(const LevelLattice& lattice, int first) {
  std::uint64_t texels = 0;
  for (int l = first; l < first + level_count(lattice, first); ++l) texels += lattice.size(l);
  return texels * sizeof(float);
}

int finest_level_within(const LevelLattice& lattice, int wanted, std::uint64_t bytes) {
  for (int level = std::clamp(wanted, 1, kMostFinest); level <= kMostFinest; ++level) {
    if (level_bytes(lattice, level) <= bytes) return level;
  }
  throw Error(ErrorKind::usage,
              compose("levels of detail of this grid take ", format_bytes(level_bytes(lattice, kMostFinest)),
                      " at least, where ", format_bytes(bytes),
                      " are kept for them, an eighth of the memory; give more, or ", option("lod", "off")));
}

}  // namespace weir
