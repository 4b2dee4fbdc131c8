// sample_host FILE.nvdb X Y Z ...: trilinear values at positions in voxels, read directly from the mapped file.
#include <cstdio>
#include <cstdlib>

#include "format/base/error.h"
#include "format/nanovdb/nvdb_file.h"
#include "gpu/volume/volume_sampler.h"

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  try {
    const weir::NvdbFile file(argv[1]);        // mapped and checked: no later call reads outside the file
    const weir::LeafTable table(file.grid());  // 4 bytes for each 8^3 voxels, and all packed blocks, decoded
    const weir::VolumeSampler volume{table.view(), weir::Filter::trilinear};
    for (int a = 2; a + 2 < argc; a += 3) {
      const weir::Float3 at{std::strtof(argv[a], nullptr), std::strtof(argv[a + 1], nullptr),
                            std::strtof(argv[a + 2], nullptr)};
      std::printf("%g\n", volume.smooth(at));
    }
  } catch (const weir::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
  }
}
