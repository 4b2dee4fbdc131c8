#include "ingest/plan/strided_copy.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace weir {
namespace {

/// Edge of a tile in voxels, along x and along the faster of y and z. A cache line of either side is used up while it
/// is in the cache.
constexpr std::int64_t kTileEdge = 16;

using Offsets = std::array<std::int64_t, 3>;

// `stride` and `out_stride` are in bytes, in the order x, faster of y and z, slower of y and z. `extent` has the same
// order.
template <std::size_t Bytes>
void copy_tiles(const std::byte* source, const Offsets& stride, std::byte* out, const Offsets& out_stride,
                const Offsets& extent) {
  for (std::int64_t slow = 0; slow < extent[2]; ++slow) {
    for (std::int64_t fast = 0; fast < extent[1]; fast += kTileEdge) {
      const std::int64_t fast_end = std::min(fast + kTileEdge, extent[1]);
      for (std::int64_t left = 0; left < extent[0]; left += kTileEdge) {
        const std::int64_t x_end = std::min(left + kTileEdge, extent[0]);
        for (std::int64_t f = fast; f < fast_end; ++f) {
          const std::byte* const from = source + f * stride[1] + slow * stride[2];
          std::byte* const to = out + f * out_stride[1] + slow * out_stride[2];
          for (std::int64_t x = left; x < x_end; ++x) std::memcpy(to + x * out_stride[0], from + x * stride[0], Bytes);
        }
      }
    }
  }
}

}  // namespace

void copy_voxels(const StridedVoxels& from, const Box& part, std::byte* out) {
  const auto bytes = static_cast<std::int64_t>(from.value_bytes);
  const auto& stride = from.stride;
  const Index3 e = part.extent();
  const auto at = [&](const Index3& i) { return from.first + (i.x * stride[0] + i.y * stride[1] + i.z * stride[2]); };
  const Index3 corner = part.lo - from.box.lo;
  if (stride[0] == bytes) {
    const bool rows_join = stride[1] == e.x * bytes;
    const bool planes_join = rows_join && stride[2] == e.x * e.y * bytes;
    const std::int64_t run = e.x * (rows_join ? e.y : 1) * (planes_join ? e.z : 1);
    for (std::int64_t i = 0; i < part.voxels(); i += run) {
      std::memcpy(out + i * bytes, at(corner + index_at(i, e)), static_cast<std::size_t>(run * bytes));
    }
    return;
  }
  Offsets in{stride[0], stride[1], stride[2]};
  Offsets to{bytes, e.x * bytes, e.x * e.y * bytes};
  Offsets extent{e.x, e.y, e.z};
  if (std::abs(in[1]) > std::abs(in[2])) {
    for (Offsets* of : {&in, &to, &extent}) std::swap((*of)[1], (*of)[2]);
  }
  switch (from.value_bytes) {
    case 1:
      return copy_tiles<1>(at(corner), in, out, to, extent);
    case 2:
      return copy_tiles<2>(at(corner), in, out, to, extent);
    case 4:
      return copy_tiles<4>(at(corner), in, out, to, extent);
    default:
      return copy_tiles<8>(at(corner), in, out, to, extent);
  }
}

}  // namespace weir
