// Assigns each frequency of a block to a shell of equal wave number.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "format/base/index.h"

namespace weir {

/// Shell j has the frequencies whose length, in cycles per world unit, lies within half a step of j * step. Shell 1
/// also has the shorter frequencies, except the mean, which is in no shell. The step is the distance of two
/// frequencies along the longest axis in world units, but at least 1/kMostShells of the highest frequency. Shells may
/// be empty.
class WaveShells {
 public:
  /// The largest number of shells. The sums of one shell take 1.6 KiB in each thread.
  static constexpr double kMostShells = 512;

  /// The shells of blocks of `extent` voxels; `spacing`: world units per voxel.
  WaveShells(const Index3& extent, const std::array<double, 3>& spacing);

  std::size_t count() const { return modes_.size(); }
  double wave_number(std::size_t shell) const { return static_cast<double>(shell) * step_; }
  /// Returns the frequencies in a shell, counted over all extent.x * extent.y * extent.z frequencies except the mean.
  std::uint64_t modes(std::size_t shell) const { return modes_[shell]; }
  /// Returns the lowest frequency in a shell, in cycles per world unit.
  double lowest(std::size_t shell) const { return lowest_[shell]; }

  /// The shell of a frequency of BlockTransform::frequencies (x fastest), and how many frequencies it stands for: 1, 2
  /// if its conjugate is left out, 0 for the mean.
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
