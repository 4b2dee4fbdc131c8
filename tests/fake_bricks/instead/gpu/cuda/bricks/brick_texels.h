// In place of the texels that kernels write to a surface: those of the pretended device's arrays.
#pragma once

#include <cuda_runtime_api.h>

#include "gpu/math/vector3.h"
#include "tests/fake_cuda/fake_array.h"

namespace weir {

namespace test {

template <class Texel>
struct FakeTexels {
  static constexpr bool kSixteenBits = sizeof(Texel) == 2;

  cudaSurfaceObject_t surface = 0;

  void write(const Int3& at, Texel value) const { array_of(surface).write(at, value); }
};

}  // namespace test

template <class Texel>
using SurfaceTexels = test::FakeTexels<Texel>;

}  // namespace weir
