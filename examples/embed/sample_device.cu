// sample_device FILE.nvdb X Y Z ...: like sample_host, but the device reads the values.
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

#include "format/base/error.h"
#include "gpu/cuda/grid_loader.h"
#include "gpu/cuda/runtime/device_array.h"
#include "gpu/volume/volume_sampler.h"

__global__ void sample(weir::VolumeSampler volume, const weir::Float3* at, float* values) {
  values[threadIdx.x] = volume.smooth(at[threadIdx.x]);
}

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  try {
    weir::use_device(0);
    const weir::NvdbFile file(argv[1]);
    const weir::DeviceGrid grid = weir::load_grid(file, {});
    std::printf("%.1f GB/s, %s\n", grid.report().gb_per_s(), weir::load_path_name(grid.report().path).data());

    const weir::LeafTable host(file.grid());
    weir::LeafTableView table = host.view();  // in host memory; the lines below make it the device's
    const auto blocks = static_cast<std::size_t>(table.count.x) * table.count.y * table.count.z;
    const weir::DeviceArray<std::uint32_t> entries({table.entries, blocks});
    const weir::DeviceArray<float> tile_values({table.tile_values, table.tile_count});
    table.entries = entries.data();
    table.tile_values = tile_values.data();
    if (table.leaves != nullptr) table.leaves = grid.data() + (table.leaves - file.grid().data().data());

    std::vector<weir::Float3> at;
    for (int a = 2; a + 2 < argc; a += 3) {
      at.push_back(
          {std::strtof(argv[a], nullptr), std::strtof(argv[a + 1], nullptr), std::strtof(argv[a + 2], nullptr)});
    }
    const weir::DeviceArray<weir::Float3> positions{std::span<const weir::Float3>(at)};
    const weir::DeviceArray<float> values(at.size());
    const weir::VolumeSampler volume{table, weir::Filter::trilinear};
    sample<<<1, static_cast<unsigned>(at.size())>>>(volume, positions.data(), values.data());
    weir::check_cuda(cudaGetLastError(), "sampling");
    for (const float value : values.download()) std::printf("%g\n", value);
  } catch (const weir::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
  }
}
