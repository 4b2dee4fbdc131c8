// The CPU renderer's rate, in camera samples a second of one thread, by mode,
// filter and macrocell edge, on a synthetic cloud converted at rate 8.
//
// Environment: WEIR_BENCH_DIM (voxels along the cube, default 256).
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "compressor/conversion.h"
#include "format/base/text.h"
#include "format/nanovdb/nvdb_file.h"
#include "gpu/render/cpu_renderer.h"
#include "gpu/render/render_scene.h"
#include "ingest/synthetic/synthetic.h"

namespace weir {
namespace {

/// The cloud as a mapped file; its name is gone at once, the mapping stays.
NvdbFile converted_cloud() {
  const char* text = std::getenv("WEIR_BENCH_DIM");
  const std::int64_t dim = text != nullptr ? parse_int(text).value_or(256) : 256;
  const std::string path =
      (std::filesystem::temp_directory_path() / cat("weir_bench_render_", ::getpid(), ".nvdb")).string();
  const auto source = open_synthetic("cloud", {{dim, dim, dim}, 1});
  ConversionOptions options;
  options.output = path;
  options.budget = {.kind = Budget::Kind::rate, .rate = 8};
  const auto files = make_posix_file_system();
  convert_volume(*source, options, {}, *files);
  NvdbFile file(path);
  std::filesystem::remove(path);
  std::filesystem::remove(sidecar_path(path));
  return file;
}

void render(benchmark::State& state, RenderMode mode, Filter filter, std::int64_t cell) {
  static const NvdbFile file = converted_cloud();
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
