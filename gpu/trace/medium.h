// What a ray travels through: a volume, its transfer function, its majorants, and how much light a collision keeps.
// One type for host and device. Volume is any type with `sample` and `smooth` (see volume_sampler.h,
// levelled_volume.h).
#pragma once

#include "format/leaf/bounds.h"
#include "gpu/math/dda.h"
#include "gpu/math/random.h"
#include "gpu/math/vector3.h"
#include "gpu/scene/transfer_function.h"
#include "gpu/volume/level_choice.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

/// Largest extinction, per shortest voxel edge. Anything above is as good as a wall: a voxel of it lets exp(-64)
/// through. It bounds the tentative collisions of a flight past a wall, because the wall's majorant holds in all of
/// its cell.
inline constexpr float kMaxExtinction = 64.0F;

/// All of a medium except its volume.
struct MediumProperties {
  TransferFunctionView transfer;
  CellLattice cells;
  RayBox shown;                         ///< the visible part of the volume, inside the domain
  const float* cell_opacity = nullptr;  ///< largest opacity of each cell
  const MinMax* cell_values = nullptr;  ///< bounds of the values of each cell
  Float3 stretch{1, 1, 1};              ///< edges of a voxel in units of the shortest edge
  float density = 1;                    ///< extinction at opacity 1, per unit of length
  float albedo = 1;                     ///< fraction of light scattered at a collision; multiplied by the colour
  float emission = 0;                   ///< source radiance at a collision; multiplied by the colour
  float g = 0;                          ///< mean cosine of scattering

  WEIR_HOST_DEVICE float extinction(float opacity) const { return lesser(opacity * density, kMaxExtinction); }
  WEIR_HOST_DEVICE float majorant(std::int64_t cell) const { return extinction(cell_opacity[cell]); }

  /// Returns the ray from `origin` (index space) along a unit direction of physical space.
  WEIR_HOST_DEVICE Ray ray(const Float3& origin, const Float3& direction) const {
    return {origin, direction / stretch};
  }
};

template <class Volume>
struct Medium : MediumProperties {
  Volume volume;

  /// Returns the distance between samples, in shortest voxel edges, at position `p` of a ray of `length`. It is
  /// `voxel_step` times the edge of the cubes that look-ups read at `p`. This edge counts as no longer than a cell or
  /// the ray, because otherwise rays would miss thin features. The result is at most `length`, so that the shortest
  /// ray has a sample.
  WEIR_HOST_DEVICE float sample_step(float voxel_step, const Float3& p, float length) const {
    return lesser(voxel_step * lesser(lesser(spacing(volume, p), cells.edge), greater(length, 1.0F)), length);
  }

  /// Returns the colour at a position inside the domain, as a ray of this kind sees it. Filters may draw random
  /// numbers.
  WEIR_HOST_DEVICE Rgba colour(const Float3& position, RayKind kind, Random& random) const {
    if constexpr (requires { volume.sample(position, kind, random); }) {
      return transfer.at(volume.sample(position, kind, random));
    } else {
      return transfer.at(volume.sample(position, random));
    }
  }
};

/// Returns the colour of a table entry without its opacity.
WEIR_HOST_DEVICE inline Float3 rgb(const Rgba& c) { return {c.r, c.g, c.b}; }

}  // namespace weir
