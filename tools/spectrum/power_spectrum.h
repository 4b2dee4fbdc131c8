// The power of a source, of its converted file and of the error, by wave number. The power is the mean over windowed
// blocks (P. Welch, "The use of fast Fourier transform for the estimation of power spectra", IEEE Trans. Audio
// Electroacoust. 15, 1967), which takes little memory however large the volume is.
#pragma once

#include <cstdint>
#include <vector>

#include "compressor/compare/compare.h"
#include "format/base/index.h"
#include "format/nanovdb/nvdb_grid.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Voxels along an axis of a block; fewer if the volume has fewer.
inline constexpr std::int64_t kSpectrumBlock = 64;
/// Bytes that each thread needs: a block's values, two transforms of it and the shells' sums.
inline constexpr std::uint64_t kSpectrumThreadBytes = std::uint64_t{8} << 20U;

struct PowerSpectrum {
  struct Shell {
    double wave_number = 0;   ///< cycles per world unit
    std::uint64_t modes = 0;  ///< frequencies of a block in the shell
    double source = 0;        ///< power in the shell, value^2; the sum over all shells is the variance under the window
    double decoded = 0;
    double error = 0;   ///< power of decoded - source
    double lowest = 0;  ///< lowest frequency in the shell, cycles per world unit
  };
  Index3 block;                ///< voxels
  std::uint64_t blocks = 0;    ///< blocks in the mean
  std::uint64_t left_out = 0;  ///< blocks left out because a value is not finite
  std::vector<Shell> shells;   ///< by rising wave number, only shells with modes; empty without a block
};

/// Computes the spectrum. Blocks begin at every half of their length along each axis, from the volume's lowest voxel
/// on; one more block ends with the axis. From each block its weighted mean is subtracted, then it is weighed by
/// sin^2(pi (n + 1/2) / N) along each axis (Hann). Results depend on neither block size nor threads. Throws as
/// compare_volumes; Error(usage) without FFTW.
PowerSpectrum power_spectrum(VolumeSource& source, const NvdbGrid& grid, const CompareOptions& options);

}  // namespace weir
