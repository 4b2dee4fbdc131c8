// A volume with levels of detail: voxels near the camera, and means of cubes of voxels where a pixel is wider than a
// voxel. For host and device.
#pragma once

#include <cmath>

#include "gpu/math/random.h"
#include "gpu/volume/level_choice.h"
#include "gpu/volume/level_lattice.h"

namespace weir {

/// The levels as look-ups use them. `Texels` has smooth(q), which filters trilinearly; texel i covers [i, i + 1), and
/// positions are clamped to the edge.
template <class Texels>
struct LevelsView {
  LevelLattice lattice;
  int first = 1;
  int count = 0;
  Texels texels[kMostLevels];

  /// Returns the value at a position (voxels from the domain's lowest corner) for `level` >= first. Between two
  /// levels it is a mixture of both.
  WEIR_HOST_DEVICE float at(const Float3& p, float level) const {
    const float above = lesser(level - static_cast<float>(first), static_cast<float>(count - 1));
    const int i = static_cast<int>(above);
    const float share = above - static_cast<float>(i);
    const float fine = texels[i].smooth(lattice.position(p, first + i));
    if (share == 0.0F) return fine;
    const float coarse = texels[i + 1].smooth(lattice.position(p, first + i + 1));
    return multiply_add(1.0F - share, fine, multiply_add(share, coarse, 0.0F));
  }
};

/// volume_sampler.h says what a tracer asks of a volume, level_choice.h how the level is chosen.
template <class Fine, class Texels>
struct LevelledVolume {
  Fine fine;
  LevelsView<Texels> levels;
  LevelChoice choice;

  WEIR_HOST_DEVICE float sample(const Float3& p, RayKind kind, Random& random) const {
    return at(p, choice.level(p, kind), [&] { return fine.sample(p, random); });
  }
  /// Returns the value that a ray from the camera sees.
  WEIR_HOST_DEVICE float smooth(const Float3& p) const {
    return at(p, choice.level(p, RayKind::camera), [&] { return fine.smooth(p); });
  }
  /// Returns the edge, in voxels, of the cubes that smooth() reads.
  WEIR_HOST_DEVICE float spacing(const Float3& p) const {
    const float level = choice.level(p, RayKind::camera);
    return coarse(level) ? std::exp2(lesser(level, static_cast<float>(levels.first + levels.count - 1))) : 1.0F;
  }

 private:
  // Reads voxels by look_up() below level `first` - 1, and mixes voxels and the first level up to level `first`. At
  // the eye the level is -infinity.
  template <class LookUp>
  WEIR_HOST_DEVICE float at(const Float3& p, float level, const LookUp& look_up) const {
    const float above = level - static_cast<float>(levels.first - 1);
    if (above >= 1.0F) return levels.at(p, level);
    const float voxels = found(p, look_up);
    if (!(above > 0.0F)) return voxels;
    return multiply_add(1.0F - above, voxels,
                        multiply_add(above, levels.at(p, static_cast<float>(levels.first)), 0.0F));
  }
  // Returns what look_up() finds in the voxels. If they are missing (paged_sampler.h), returns the finest level.
  template <class LookUp>
  WEIR_HOST_DEVICE float found(const Float3& p, const LookUp& look_up) const {
    if constexpr (requires { Fine::missed(); }) {
      const bool before = Fine::missed();
      Fine::set_missed(false);
      const float value = look_up();
      if (Fine::missed()) return levels.at(p, static_cast<float>(levels.first));
      Fine::set_missed(before);
      return value;
    } else {
      return look_up();
    }
  }
  // False for a look-up at the eye itself, because its level is -infinity.
  WEIR_HOST_DEVICE bool coarse(float level) const { return level >= static_cast<float>(levels.first); }
};

}  // namespace weir
