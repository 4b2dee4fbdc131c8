#include "format/packed/block_decode.h"

#include <cstring>

#include "format/base/simd.h"
#include "format/packed/transpose_lanes.h"

namespace weir {
namespace {

WEIR_SIMD void transform_in_lanes(float* values, float mean, float minimum, float maximum) {
  const Floats8 none{};
  for (unsigned x = 0; x < 8; ++x) {
    Floats8 rows[8];
    std::memcpy(rows, values + 64 * x, sizeof rows);
    transpose_8(rows);
    inverse_transform_8(rows);  // along z, of eight y at once
    transpose_8(rows);
    inverse_transform_8(rows);  // along y
    std::memcpy(values + 64 * x, rows, sizeof rows);
  }
  for (unsigned y = 0; y < 8; ++y) {
    Floats8 rows[8];
    for (unsigned x = 0; x < 8; ++x) std::memcpy(&rows[x], values + 64 * x + 8 * y, sizeof rows[x]);
    inverse_transform_8(rows);  // along x
    for (unsigned x = 0; x < 8; ++x) {
      Floats8 v = (mean - none) + rows[x];
      v = v < minimum ? minimum - none : v;
      v = v > maximum ? maximum - none : v;
      std::memcpy(values + 64 * x + 8 * y, &v, sizeof v);
    }
  }
}

struct LaneTransform {
  void operator()(float* values, float mean, const BlockConstants& constants) const {
    transform_in_lanes(values, mean, constants.minimum, constants.maximum);
  }
};

}  // namespace

bool decode_block(const BlockConstants& constants, const MeanRange& range, const std::byte* stream, std::uint32_t bytes,
                  float* values) {
  return packed_detail::decode_block(constants, kBlockScan, range, stream, bytes, values, LaneTransform());
}

}  // namespace weir
