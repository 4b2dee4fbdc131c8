// Power of a source, of the file made from it and of the error, by wave number: the mean over windowed blocks (P.
// Welch, "The use of fast Fourier transform for the estimation of power spectra", IEEE Trans. Audio Electroacoust. 15,
// 1967), which takes little memory however large the volume is.
#pragma once

#include <cstdint>
#include <vector>

#include "compressor/compare/compare.h"
#include "format/base/index.h"
#include "format/nanovdb/nvdb_grid.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Voxels along an axis of a block; fewer where the volume has fewer.
inline constexpr std::int64_t kSpectrumBlock = 64;
/// What each thread needs, in bytes: a block's values, two transforms of it and the shells' sums.
inline constexpr std::uint64_t kSpectrumThreadBytes = std::uint64_t{8} << 20U;

struct PowerSpectrum {
  struct Shell {
    double wave_number = 0;   ///< cycles per world unit
    std::uint64_t modes = 0;  ///< frequencies of a block in it
    double source = 0;        ///< power in it, value^2; over all shells they sum up to the variance under the window
    double decoded = 0;
    double error = 0;   ///< of decoded - source
    double lowest = 0;  ///< the lowest of its frequencies, in cycles per world unit
  };
  Index3 block;                ///< voxels
  std::uint64_t blocks = 0;    ///< over which the mean is taken
  std::uint64_t left_out = 0;  ///< those with a value that is not finite
  std::vector<Shell> shells;   ///< rising wave numbers, those with modes; none without a block
};

/// Blocks begin at every half of their length along each axis, from the volume's lowest voxel on, and once more so that
/// the last one ends with the axis.
/// Each is weighed by sin^2(pi (n + 1/2) / N) along each axis (Hann), after its mean under that weight was taken off.
/// Results depend on neither block size nor threads. Throws as compare_volumes; Error(usage) without FFTW.
PowerSpectrum power_spectrum(VolumeSource& source, const NvdbGrid& grid, const CompareOptions& options);

}  // namespace weir
