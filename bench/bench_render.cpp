// Measures the CPU renderer's rate, in camera samples a second of one thread, by mode, filter and macrocell edge, on a
// synthetic cloud converted at rate 8.
//
// Environment: WEIR_BENCH_DIM (voxels along the cube, default 256).
#include <benchmark/benchmark.h>

#include "bench/converted_sample.h"
#include "format/nanovdb/nvdb_file.h"
#include "gpu/render/cpu_renderer.h"
#include "gpu/render/render_scene.h"

namespace weir {
namespace {

void render(benchmark::State& state, RenderMode mode, Filter filter, std::int64_t cell) {
  static const NvdbFile file = converted_sample("cloud", Encoding::float32, 8);
  Scene scene;
  scene.mode = mode;
  const RenderScene prepared(file.grid(), scene, {.width = 160, .height = 120, .filter = filter, .cell = cell});
  CpuRenderOptions cpu;
  cpu.samples = mode == RenderMode::path ? 8 : 2;
  cpu.threads = 1;
  for (auto _ : state) benchmark::DoNotOptimize(render_cpu(prepared.task(), cpu));
  state.SetItemsProcessed(state.iterations() * 160 * 120 * cpu.samples);
}

BENCHMARK_CAPTURE(render, path_trilinear_cell16, RenderMode::path, Filter::trilinear, 16);
BENCHMARK_CAPTURE(render, path_trilinear_cell32, RenderMode::path, Filter::trilinear, 32);
BENCHMARK_CAPTURE(render, path_stochastic_cell16, RenderMode::path, Filter::stochastic, 16);
BENCHMARK_CAPTURE(render, path_stochastic_cell32, RenderMode::path, Filter::stochastic, 32);
BENCHMARK_CAPTURE(render, path_nearest_cell16, RenderMode::path, Filter::nearest, 16);
BENCHMARK_CAPTURE(render, dvr_trilinear_cell16, RenderMode::dvr, Filter::trilinear, 16);
BENCHMARK_CAPTURE(render, dvr_stochastic_cell16, RenderMode::dvr, Filter::stochastic, 16);
BENCHMARK_CAPTURE(render, iso_trilinear_cell16, RenderMode::iso, Filter::trilinear, 16);
BENCHMARK_CAPTURE(render, mip_trilinear_cell16, RenderMode::mip, Filter::trilinear, 16);

}  // namespace
}  // namespace weir

BENCHMARK_MAIN();
