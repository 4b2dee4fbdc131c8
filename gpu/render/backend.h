// What renders: the CPU or a device, behind one interface. A back end loads
// volumes, several at a time if asked, and makes pictures of them.
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

/// How a volume came in.
struct LoadSummary {
  std::string way;           ///< "mapped", "decoded" or "cached" where packed; for a device, a load_path_name
  std::uint64_t bytes = 0;   ///< of the grid, tail padding left out
  double seconds = 0;        ///< of the transfer alone
  std::string note;          ///< why a faster way was refused; empty: none was
  std::uint64_t memory = 0;  ///< bytes taken of the host's, which VoxelMemory limits; 0: not counted
};

/// A volume that its back end can render, loaded for as long as the object lives.
class LoadedVolume {
 public:
  virtual ~LoadedVolume() = default;
  virtual const VolumeInfo& info() const = 0;
  virtual const LoadSummary& load_summary() const = 0;
};

struct Picture {
  Image image;  ///< mean radiance
  ToneMapping tone;
  double render_s = 0;       ///< of the samples alone
  CacheCounts cache = {};    ///< of a volume that was loaded "cached"; of bricks on a device, which counts no look-ups
  std::uint64_t missed = 0;  ///< of a draft: pixels whose last sample did without something that was not there
  int finest_level = 0;      ///< of the levels of detail that it was made with; 0: voxels alone
  std::string levels_note;   ///< why it was made with coarser levels than it asked for, or none; empty: it was not
  std::string memory_note;  ///< a warning that a device had less memory than was meant for the volume; empty: it had it
};

class Backend {
 public:
  virtual ~Backend() = default;
  virtual std::string_view name() const = 0;
  /// `file` stays mapped as long as the volume needs it. `cell`: voxels along a macrocell's edge, at least; 0: what is
  /// fastest here. Throws as LeafTable, CachedBlocks and, of the CPU, plan_voxels. The memory of `reuse` (may be null),
  /// a volume of this back end that is no longer needed, is used again.
  virtual std::unique_ptr<LoadedVolume> load(std::shared_ptr<const NvdbFile> file, std::int64_t cell,
                                             std::unique_ptr<LoadedVolume> reuse) = 0;
  /// Loads a dense volume; `volume` is kept as long as it is needed.
  virtual std::unique_ptr<LoadedVolume> load_dense(std::shared_ptr<const DenseVolume> volume, std::int64_t cell) = 0;
  /// `volume` must be this back end's. May run while another volume is loaded from another thread. Throws
  /// Error(interrupted) where `cancel` was set, and as RenderSetup.
  virtual Picture render(LoadedVolume& volume, const Scene& scene, const RenderOptions& options,
                         const SampleOptions& sampling) = 0;
};

/// `threads` 0: all of the machine's. `memory` is of files; a dense volume was read by the caller.
std::unique_ptr<Backend> make_cpu_backend(int threads, const VoxelMemory& memory = {});

}  // namespace weir
