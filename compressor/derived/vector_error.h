// Errors of the vorticity and the divergence of a vector field. Each component of the field is a volume of its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "compressor/compare/pair_stream.h"
#include "compressor/leaf/exact_sum.h"

namespace weir {

/// The error of one quantity, in value per world unit.
struct QuantityError {
  double rms = 0;                      ///< root mean square of the error (for a vector, of the error's length)
  double source_rms = 0;               ///< root mean square of the source's quantity
  std::optional<double> relative_rms;  ///< rms / source_rms; unset if source_rms is 0
  double max_abs = 0;                  ///< the largest error
};

struct VectorErrors {
  QuantityError vorticity;     ///< (dw/dy - dv/dz, du/dz - dw/dx, dv/dx - du/dy)
  QuantityError divergence;    ///< du/dx + dv/dy + dw/dz
  std::uint64_t voxels = 0;    ///< voxels that the errors cover
  std::uint64_t left_out = 0;  ///< voxels left out because a value of their differences is not finite
};

/// Finds the errors for the components along x, y and z, with the differences that gradient_error takes. Reads all
/// components once, side by side. Results depend on neither block size nor threads. Throws Error(input) if the sources
/// differ in domain or spacing or a grid has another domain, what reading and decoding throw, and Error(interrupted).
VectorErrors vector_errors(const std::array<PairedVolume, 3>& components, const CompareOptions& options);

}  // namespace weir
