// Which shell of equal wave number each frequency of a block belongs to.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "format/base/index.h"

namespace weir {

/// Shell j has the frequencies whose length, in cycles per world unit, lies within half a step of j * step, and shell 1
/// the shorter ones, too, but for the mean, which is in none; the step is the largest distance of two frequencies along
/// an axis, so that no shell between is empty.
class WaveShells {
 public:
  /// Of blocks of `extent` voxels; `spacing`: world units per voxel.
  WaveShells(const Index3& extent, const std::array<double, 3>& spacing);

  std::size_t count() const { return modes_.size(); }
  double wave_number(std::size_t shell) const { return static_cast<double>(shell) * step_; }
  /// Frequencies in a shell, of all extent.x * extent.y * extent.z but the mean.
  std::uint64_t modes(std::size_t shell) const { return modes_[shell]; }

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
};

}  // namespace weir
