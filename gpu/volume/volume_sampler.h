// Filtered values of a volume at any position. Coordinates are voxels from the domain's lowest corner: voxel i covers
// [i, i + 1), and its centre is i + 0.5. Positions outside are clamped to the domain, like a clamp-to-edge texture.
#pragma once

#include "gpu/math/random.h"
#include "gpu/math/vector3.h"
#include "gpu/volume/leaf_table.h"

namespace weir {

/// nearest: the voxel that covers the position. trilinear: a blend of the 8 voxels around it. stochastic: one of
/// these 8, chosen with the probability of its weight; its expectation is the trilinear value, at an eighth of the
/// loads.
enum class Filter { nearest, trilinear, stochastic };

/// The volume that a tracer sees: `sample` for look-ups that may draw random numbers, `smooth` for look-ups that must
/// be a function of the position. Any type with these two and `extent` may replace it. `Table` holds the voxels:
/// `extent`, `voxel(i)`, and `taps`, the eight voxels that a blend needs.
template <class Table>
struct FilteredVolume {
  Table table;
  Filter filter = Filter::trilinear;

  WEIR_HOST_DEVICE Float3 extent() const {
    return {static_cast<float>(table.extent.x), static_cast<float>(table.extent.y), static_cast<float>(table.extent.z)};
  }

  WEIR_HOST_DEVICE float sample(const Float3& p, Random& random) const {
    if (filter != Filter::stochastic) return smooth(p);
    Int3 i;
    Float3 f;
    corner(p, i, f);
    return table.voxel({upper(i.x, random.uniform() < f.x, table.extent.x),
                        upper(i.y, random.uniform() < f.y, table.extent.y),
                        upper(i.z, random.uniform() < f.z, table.extent.z)});
  }

  /// Filters by `nearest` or trilinearly; trilinearly also for the filter `stochastic`.
  WEIR_HOST_DEVICE float smooth(const Float3& p) const {
    if (filter == Filter::nearest) return table.voxel(nearest(p));
    return trilinear(p);
  }

  /// Like smooth(), for values that are reported, not drawn. A voxel with weight 0 has no effect even if it is NaN or
  /// infinite, so the value at a voxel's centre is the voxel's.
  float value(const Float3& p) const {
    if (filter == Filter::nearest) return table.voxel(nearest(p));
    return trilinear(p, [](float a, float b, float t) { return t == 0 ? a : mix(a, b, t); });
  }

  WEIR_HOST_DEVICE float trilinear(const Float3& p) const {
    return trilinear(p, [](float a, float b, float t) { return mix(a, b, t); });
  }

 private:
  template <class Mix>
  WEIR_HOST_DEVICE float trilinear(const Float3& p, const Mix& mixed) const {
    Int3 i;
    Float3 f;
    corner(p, i, f);
    float c[8];
    if (table.taps(i, c)) return c[0];
    const float y0 = mixed(mixed(c[0], c[1], f.x), mixed(c[2], c[3], f.x), f.y);
    const float y1 = mixed(mixed(c[4], c[5], f.x), mixed(c[6], c[7], f.x), f.y);
    return mixed(y0, y1, f.z);
  }

  WEIR_HOST_DEVICE static std::int32_t voxel_of(float p, std::int32_t extent) {
    return lesser(static_cast<std::int32_t>(clamped(p, 0.0F, static_cast<float>(extent))), extent - 1);
  }
  WEIR_HOST_DEVICE Int3 nearest(const Float3& p) const {
    return {voxel_of(p.x, table.extent.x), voxel_of(p.y, table.extent.y), voxel_of(p.z, table.extent.z)};
  }
  // Sets the lowest voxel of the 2 x 2 x 2 around p, and the weights of the upper voxels.
  WEIR_HOST_DEVICE static void corner(float p, std::int32_t extent, std::int32_t& i, float& f) {
    const float q = clamped(p - 0.5F, 0.0F, static_cast<float>(extent - 1));
    i = lesser(static_cast<std::int32_t>(q), extent - 1);  // float(extent - 1) rounds up beyond 2^24
    f = q - static_cast<float>(i);
  }
  WEIR_HOST_DEVICE void corner(const Float3& p, Int3& i, Float3& f) const {
    corner(p.x, table.extent.x, i.x, f.x);
    corner(p.y, table.extent.y, i.y, f.y);
    corner(p.z, table.extent.z, i.z, f.z);
  }
};

/// The voxels of a NanoVDB file.
using VolumeSampler = FilteredVolume<LeafTableView>;

/// True for a LevelledVolume (levelled_volume.h).
template <class Volume>
inline constexpr bool kHasLevels = requires(const Volume& volume, const Float3& p) {
  volume.spacing(p);
};

/// Returns the distance, in voxels, between two values that `volume` distinguishes at `p`.
template <class Volume>
WEIR_HOST_DEVICE float spacing(const Volume& volume, const Float3& p) {
  if constexpr (kHasLevels<Volume>) {
    return volume.spacing(p);
  } else {
    return 1.0F;
  }
}

/// Returns central differences over two voxels, or two cubes of voxels, in value per voxel.
template <class Volume>
WEIR_HOST_DEVICE Float3 gradient(const Volume& volume, const Float3& p) {
  const float reach = spacing(volume, p);
  const float weight = 0.5F / reach;
  const auto slope = [&](const Float3& d) { return weight * volume.smooth(p + d) - weight * volume.smooth(p - d); };
  return {slope({reach, 0, 0}), slope({0, reach, 0}), slope({0, 0, reach})};
}

}  // namespace weir
