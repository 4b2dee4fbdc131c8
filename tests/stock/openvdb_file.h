// Files written by OpenVDB, with its own accessor as the oracle. The only source of this folder that compiles
// OpenVDB's headers is behind it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "format/base/index.h"

namespace weir::test {

enum class GridKind { float32, float64, int32, int64, boolean, mask, vec3s, vec3d, vec3i, points };

enum class Compression { none, active_mask, zip, zip_active_mask, blosc, blosc_active_mask };

/// A grid to be written. Cheap to copy: copies share it.
class OpenVdbGrid {
 public:
  /// Empty, of background 2 (true, for bool).
  OpenVdbGrid(GridKind kind, const std::string& name);

  /// Sets every voxel of `box` to `scale` * (x + 3 y - 7 z + 0.125), active; for bool and mask to whether that
  /// rounds to an even number. A vector of value v is (v, v + 1, -2 v), here and below.
  OpenVdbGrid& fill(const Box& box, double scale = 1);
  OpenVdbGrid& set_on(const Index3& i, double value);
  OpenVdbGrid& set_off(const Index3& i, double value);
  /// A tile of 8 (level 1), 128 (2) or 4096 (3) voxels.
  OpenVdbGrid& tile(unsigned level, const Index3& origin, double value, bool active);
  OpenVdbGrid& save_as_half();
  /// "level set", "fog volume" or "staggered".
  OpenVdbGrid& class_is(const std::string& name);
  OpenVdbGrid& place(const std::array<double, 3>& scale, const std::array<double, 3>& translate);
  /// About z, after place.
  OpenVdbGrid& rotate(double radians);
  OpenVdbGrid& frustum();
  /// A grid of the same tree under another name and transform.
  OpenVdbGrid instance(const std::string& name) const;

  double value(const Index3& i) const;
  std::array<double, 3> vector(const Index3& i) const;
  Box active() const;
  std::uint64_t memory_bytes() const;  ///< OpenVDB's own figure

  struct Implementation;
  const Implementation& implementation() const { return *implementation_; }

 private:
  OpenVdbGrid() = default;
  std::shared_ptr<Implementation> implementation_;
};

/// Writes the grids with OpenVDB's own writer, as a file or as a stream without offsets.
void write_vdb(const std::string& path, const std::vector<OpenVdbGrid>& grids,
               Compression compression = Compression::active_mask, bool as_stream = false);

/// Writes a float grid as NanoVDB's own tools do.
void write_nvdb(const std::string& path, const OpenVdbGrid& grid);

}  // namespace weir::test
