// The CPU or a CUDA device renders, behind one interface. A back end loads volumes, several at a time if asked, and
// makes pictures of them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "format/nanovdb/nvdb_file.h"
#include "gpu/image/image.h"
#include "gpu/render/render_setup.h"
#include "gpu/render/sample_options.h"
#include "gpu/volume/cached_blocks.h"
#include "gpu/volume/dense_volume.h"
#include "gpu/volume/voxel_memory.h"

namespace weir {

/// How a volume was loaded.
struct LoadSummary {
  std::string way;           ///< CPU: "mapped", or "decoded" or "cached" if packed; device: a load_path_name
  std::uint64_t bytes = 0;   ///< size of the grid without tail padding
  double seconds = 0;        ///< time of the transfer alone
  std::string note;          ///< why a faster way was refused; empty if none was refused
  std::uint64_t memory = 0;  ///< bytes of host memory taken, which VoxelMemory limits; 0: not counted
};

/// A volume that its back end can render. It stays loaded as long as the object lives.
class LoadedVolume {
 public:
  virtual ~LoadedVolume() = default;
  virtual const VolumeInfo& info() const = 0;
  virtual const LoadSummary& load_summary() const = 0;
};

struct Picture {
  Image image;  ///< mean radiance
  ToneMapping tone;
  double render_s = 0;       ///< time of the samples alone
  CacheCounts cache = {};    ///< for a volume loaded as "cached", or for bricks on a device, which counts no look-ups
  std::uint64_t missed = 0;  ///< in a draft: pixels whose last sample lacked data that was not on the device
  int finest_level = 0;      ///< finest level of detail used; 0: voxels alone
  std::string levels_note;   ///< why the levels are coarser than asked for, or missing; empty if they are as asked for
  std::string memory_note;   ///< warns that a device had less memory than was meant for the volume; empty otherwise
};

class Backend {
 public:
  virtual ~Backend() = default;
  virtual std::string_view name() const = 0;
  /// Loads the grid of `file`, which stays mapped as long as the volume needs it. `cell` is the least number of
  /// voxels along a macrocell's edge; 0 means what is fastest on this back end. Reuses the memory of `reuse` (may be
  /// null), a volume of this back end that is no longer needed. Throws the errors of LeafTable and CachedBlocks and,
  /// on the CPU, of plan_voxels.
  virtual std::unique_ptr<LoadedVolume> load(std::shared_ptr<const NvdbFile> file, std::int64_t cell,
                                             std::unique_ptr<LoadedVolume> reuse) = 0;
  /// Loads a dense volume. `volume` is kept as long as the loaded volume needs it.
  virtual std::unique_ptr<LoadedVolume> load_dense(std::shared_ptr<const DenseVolume> volume, std::int64_t cell) = 0;
  /// Renders `volume`, which this back end must have loaded. Another thread may load another volume at the same time.
  /// Throws Error(interrupted) if `cancel` is set, and the errors of RenderSetup.
  virtual Picture render(LoadedVolume& volume, const Scene& scene, const RenderOptions& options,
                         const SampleOptions& sampling) = 0;
};

/// Makes the CPU back end. `threads` 0 means all of the machine's. `memory` limits the volumes of files; it does not
/// count a dense volume, which the caller has read.
std::unique_ptr<Backend> make_cpu_backend(int threads, const VoxelMemory& memory = {});

}  // namespace weir
