// One quantised leaf: its codes, the values that they decode to, and the error of these values.
#pragma once

#include <array>
#include <cstdint>

#include "compressor/leaf/leaf_quantiser.h"
#include "format/base/index.h"
#include "format/leaf/leaf_codec.h"
#include "format/leaf/leaf_record.h"

namespace weir {

struct QuantisedLeaf {
  Quantiser quantiser;
  unsigned bits_log2 = 0;
  std::array<std::uint16_t, kLeafVoxels> codes{};  ///< in leaf order
  LeafValues decoded{};                            ///< fl(fl(code * quantum) + minimum)
  double squared_error = 0;                        ///< over the finite in-domain values of the source
  double max_abs = 0;                              ///< over the finite in-domain values of the source
  Kept kept = Kept::all;                           ///< what is kept of the in-domain voxels
  std::uint32_t zeros_lost = 0;                    ///< in-domain values equal to 0 that decode to another value
};

/// The error that a quantiser minimises: the squared error, or the largest error.
enum class Fit { squares, largest };

/// Quantises the in-domain voxels (`inside`) of the leaf at `node` to 1 << bits_log2 bits: exactly if they lie on a
/// lattice that fits, otherwise with the least error (leaf_quantiser.h). `values` are finite at these voxels. `source`
/// holds the values before non-finite ones were replaced. Voxels outside the domain take the code of the nearest voxel
/// inside, so that they widen no range. `repeats` describes the values of a leaf that lies wholly in the domain.
QuantisedLeaf quantise_leaf(const LeafValues& values, const LeafValues& source, const Box& node, const Box& inside,
                            unsigned bits_log2, Fit fit = Fit::squares, const LeafRepeats& repeats = {});

}  // namespace weir
