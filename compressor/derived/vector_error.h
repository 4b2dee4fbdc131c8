// Errors of the vorticity and the divergence of a vector field, each of whose components is a volume of its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "compressor/compare/pair_stream.h"
#include "compressor/leaf/exact_sum.h"

namespace weir {

/// Of one quantity, in value per world unit.
struct QuantityError {
  double rms = 0;                      ///< root mean square of the error; of a vector's length
  double source_rms = 0;               ///< the same of the source's quantity
  std::optional<double> relative_rms;  ///< rms / source_rms; none where that is 0
  double max_abs = 0;                  ///< the largest error
};

struct VectorErrors {
  QuantityError vorticity;     ///< (dw/dy - dv/dz, du/dz - dw/dx, dv/dx - du/dy)
  QuantityError divergence;    ///< du/dx + dv/dy + dw/dz
  std::uint64_t voxels = 0;    ///< over which they are taken
  std::uint64_t left_out = 0;  ///< those at which a value that is taken is not finite
};

/// Of the components along x, y and z, by differences as gradient_error takes them. Reads all once, side by side.
/// Results depend on neither block size nor threads. Throws Error(input) where the sources differ in domain or spacing
/// or a grid has another domain; what reading and decoding throw, and Error(interrupted).
VectorErrors vector_errors(const std::array<PairedVolume, 3>& components, const CompareOptions& options);

}  // namespace weir
