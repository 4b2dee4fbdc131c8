// Which shell of equal wave number each frequency of a block belongs to.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "format/base/index.h"

namespace weir {

/// Shell j has the frequencies whose length, in cycles per world unit, lies within half a step of j * step, and shell 1
/// the shorter ones, too, but for the mean, which is in none. The step is the distance of two frequencies along the
/// longest axis in world units, but at least 1/kMostShells of the highest frequency. Shells may be empty.
class WaveShells {
 public:
  /// Sums of each shell take 1.6 KiB in each thread.
  static constexpr double kMostShells = 512;

  /// Of blocks of `extent` voxels; `spacing`: world units per voxel.
  WaveShells(const Index3& extent, const std::array<double, 3>& spacing);

  std::size_t count() const { return modes_.size(); }
  double wave_number(std::size_t shell) const { return static_cast<double>(shell) * step_; }
  /// Frequencies in a shell, of all extent.x * extent.y * extent.z but the mean.
  std::uint64_t modes(std::size_t shell) const { return modes_[shell]; }
  /// The lowest of them, in cycles per world unit.
  double lowest(std::size_t shell) const { return lowest_[shell]; }

  /// Of a frequency of BlockTransform::frequencies, x fastest: its shell, and how many frequencies it stands for: 1, 2
  /// where its conjugate is left out, 0 of the mean.
  struct Place {
    std::uint16_t shell = 0;
    std::uint16_t weight = 0;
  };
  const std::vector<Place>& places() const { return places_; }

 private:
  double step_ = 0;
  std::vector<Place> places_;
  std::vector<std::uint64_t> modes_;
  std::vector<double> lowest_;
};

}  // namespace weir
