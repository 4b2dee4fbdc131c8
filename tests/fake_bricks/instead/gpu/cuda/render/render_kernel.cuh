// In place of the kernels that draw: pixels one after the other.
#pragma once

#include "gpu/cuda/render/render_kernel.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/pixel_tile.h"
#include "gpu/cuda/volume/device_samplers.h"
#include "tests/fake_cuda/fake_runtime.h"

namespace weir {

namespace test {

/// A launch that a test can make fail.
inline void launch() { check_cuda(FakeRuntime::instance().enter("launch"), "starting the renderer"); }

}  // namespace test

template <class Volume>
void launch_render(const RenderTask<Volume>& task, std::uint32_t first, std::uint32_t last, Float3* sums,
                   cudaStream_t /*stream*/) {
  test::launch();
  for (std::int32_t y = 0; y < task.height; ++y) {
    for (std::int32_t x = 0; x < task.width; ++x) {
      Float3& sum = sums[static_cast<std::int64_t>(y) * task.width + x];
      for (std::uint32_t s = first; s < last; ++s) sum += render_sample(task, x, y, s);
    }
  }
}

}  // namespace weir
